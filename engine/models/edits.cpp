#include "engine/models/edits.hpp"

#include <bit>

namespace psygen::models {

std::uint64_t BlockEdits::hash() const {
  std::uint64_t hash = core::mix64(removed.size());
  for (const RemovedModel& r : removed)
    hash = core::combine(hash, r.index);
  for (const PlacedModel& p : placed) {
    hash = core::combine(hash, (std::uint64_t{p.id} << 32) | p.model);
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
