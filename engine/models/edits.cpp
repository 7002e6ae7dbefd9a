#include "engine/models/edits.hpp"

#include <bit>
#include <span>

namespace psygen::models {

void bind(PlacedModel& placed, const ModelType& type) {
  placed.type = type.name();
  placed.identity = type.identity();
  placed.parameter_count = static_cast<std::uint32_t>(type.parameters().size());
  const core::Bounds box = type.bounds(placed.parameters);
  placed.reach_m = {std::max({-box.min.x, -box.min.z, box.max.x, box.max.z, 0.0F}),
                    std::max(box.max.y + placed.above_m, 0.0F),
                    std::max(-box.min.y - placed.above_m, 0.0F)};
}

bool is_bound(const PlacedModel& placed, const ModelType& type) {
  if (type.name() != placed.type || type.parameters().size() != placed.parameter_count)
    return false;
  return type.identity() == placed.identity ||
         (validate(type, placed.parameters) &&
          type.mesh_size(placed.parameters, 0).layout == core::VertexLayout::kModel);
}

std::optional<ModelIndex> type_of(const PlacedModel& placed, const Registry& registry) {
  const int index = registry.find(placed.type);
  if (index < 0 || !is_bound(placed, registry[static_cast<ModelIndex>(index)])) return std::nullopt;
  return static_cast<ModelIndex>(index);
}

std::uint64_t BlockEdits::hash() const {
  std::uint64_t hash = core::mix64(removed.size());
  for (const RemovedModel& r : removed)
    hash = core::combine(hash, r.index);
  for (const PlacedModel& p : placed) {
    hash = core::combine(core::combine(hash, p.id), p.identity);
    hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(p.type))));
    for (const float v : {p.local_m.x, p.local_m.y, p.above_m})
      hash = core::combine(hash, std::bit_cast<std::uint32_t>(v));
    hash = core::combine(hash, p.parameters.hash());
  }
  for (const auto& edit : ground)
    hash = core::combine(hash, edit->content);
  return hash;
}

BlockEdits::Summary BlockEdits::summary() const {
  Summary sum{removed.size(), placed.size(), ground.size(), glm::vec3(0.0F)};
  for (const PlacedModel& p : placed)
    sum.add({0, 0, 0, p.reach_m});
  return sum;
}

}  // namespace psygen::models
