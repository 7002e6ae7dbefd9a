#include "engine/scene/facts/typical_bounds.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <optional>

#include "engine/synthesis/synthesise.hpp"

namespace psygen::scene {
namespace {

// Measured models of each type.
constexpr std::size_t kSamples = 8;
constexpr core::Bounds kWhole{glm::vec3(-1.0F), glm::vec3(1.0F)};

std::optional<core::Bounds> tight_box(const models::ModelType& type,
                                      const models::Parameters& parameters) {
  const int level = std::max(type.level_count_of(parameters) - 1, 0);
  const auto destination = synthesis::HeapDestination::make(type, parameters, level);
  if (!destination) return std::nullopt;
  const synthesis::SynthesisOutcome outcome =
      synthesis::synthesise_guarded(type, parameters, level, destination->view());
  if (!outcome.ok) return std::nullopt;
  return outcome.tight;
}

}  // namespace

std::vector<core::Bounds> typical_bounds(const models::Registry& registry,
                                         std::span<const synthesis::CostSample> samples) {
  std::vector<std::optional<core::Bounds>> found(registry.size());
  std::vector<std::size_t> taken(registry.size(), 0);
  for (const synthesis::CostSample& sample : samples) {
    if (taken[sample.model]++ >= kSamples) continue;
    const models::ModelType& type = registry[sample.model];
    const core::Bounds whole = type.bounds(sample.parameters);
    const core::Bounds tight = tight_box(type, sample.parameters).value_or(whole);
    const glm::vec3 extent = glm::max(whole.half_extent(), glm::vec3(1e-6F));
    const core::Bounds part{glm::clamp((tight.min - whole.centre()) / extent, -1.0F, 1.0F),
                            glm::clamp((tight.max - whole.centre()) / extent, -1.0F, 1.0F)};
    std::optional<core::Bounds>& all = found[sample.model];
    all = all ? core::united(*all, part) : part;
  }
  std::vector<core::Bounds> boxes;
  for (const std::optional<core::Bounds>& box : found)
    boxes.push_back(box.value_or(kWhole));
  return boxes;
}

}  // namespace psygen::scene
