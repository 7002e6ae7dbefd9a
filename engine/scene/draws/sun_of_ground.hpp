// The ground's shadow on things that are not part of it. O(levels); main thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// The share of the sun that the ground lets through to a place: that of the finest node there, 1
// where there is none. `entities`: a query that reads GroundSun.
template <class Query>
float ground_sun_at(core::WorldPosition at, double block_size_m, const Streaming& streaming,
                    const Query& entities) {
  at = core::normalised(at, block_size_m);
  for (const NodeGrid& grid : streaming.grids) {
    const visibility::NodeCoord node = visibility::node_of(at.block, grid.level());
    if (!grid.contains(node.coord)) continue;
    const GroundSun* sun = entities.template get<GroundSun>(grid.entity_of(node.coord));
    if (sun == nullptr) continue;
    const core::BlockCoord corner = visibility::corner_block(node);
    const double side_m = block_size_m * static_cast<double>(1U << grid.level());
    const glm::dvec3 in_node = -core::offset_m(corner, at, block_size_m);
    return sun_at(*sun, glm::vec2(static_cast<float>(in_node.x / side_m),
                                  static_cast<float>(in_node.z / side_m)));
  }
  return 1.0F;
}

}  // namespace psygen::scene
