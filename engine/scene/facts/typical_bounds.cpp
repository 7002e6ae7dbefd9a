#include "engine/scene/facts/typical_bounds.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <optional>

#include "engine/core/hash.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/placement.hpp"

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

constexpr std::size_t kNodesPerLevel = 2, kPerType = 24;
constexpr int kMaxBlocks = 48;

// Takes models block by block until there are enough of each type.
class ModelSamples {
 public:
  explicit ModelSamples(const WorldFacts& facts)
      : facts_(facts), taken_(facts.registry.size(), 0) {}

  void take(core::BlockCoord block, std::vector<synthesis::CostSample>& samples) {
    world::place_models(facts_.world, facts_.registry, block, placements_);
    for (const world::Placement& placement : placements_) {
      if (taken_[placement.model]++ < kPerType)
        samples.push_back({placement.model, placement.parameters});
    }
  }
  bool complete() const {
    return std::ranges::all_of(facts_.world.scatter, [this](const world::Scatter& scatter) {
      return scatter.count == 0 || taken_[scatter.model] >= kPerType;
    });
  }

 private:
  const WorldFacts& facts_;
  std::vector<std::size_t> taken_;
  std::vector<world::Placement> placements_;
};

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

std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts) {
  core::RandomStream random(0, 0, 0, 0, core::Purpose::kParameters);
  std::vector<synthesis::CostSample> samples;
  for (std::size_t k = 0; k < facts.levels.size(); ++k) {
    for (std::size_t i = 0; i < kNodesPerLevel; ++i) {
      const auto level = static_cast<std::uint8_t>(k);
      const visibility::NodeCoord node = visibility::node_of(any_block(facts.world, random), level);
      samples.push_back({facts.world.terrain_model, node_terrain(facts.world, node)});
      if (facts.levels[k].merged)
        samples.push_back({facts.merged_model, world::merged_parameters(node.coord, level)});
    }
  }
  ModelSamples models(facts);
  for (int i = 0; i < kMaxBlocks && !models.complete(); ++i)
    models.take(any_block(facts.world, random), samples);
  return samples;
}

std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block) {
  std::vector<synthesis::CostSample> samples;
  ModelSamples(facts).take(block, samples);
  return samples;
}

}  // namespace psygen::scene
