// The nodes that exist as entities: one for each node of the quadtree that may be drawn soon, and
// one for each model on it. Created and destroyed in batches, coarse nodes before fine ones and
// nearest first, within a time budget per tick. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/frame/camera.hpp"
#include "engine/scene/frame/frame_context.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/nodes/daylight.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/nodes/grid.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// Counts of one tick.
struct NodeCounts {
  std::uint32_t created = 0, destroyed = 0;
};

struct Streaming {
  std::vector<NodeGrid> grids;                        // one for each level
  std::vector<visibility::LevelDistances> distances;  // at which nodes split in this tick
  std::vector<visibility::NodeCoord> missing;         // most important last
  std::uint32_t ticks_since_listed = 0;               // since the windows were listed
  std::size_t per_tick = 0;                           // missing nodes that one tick creates
  std::uint32_t spread_ticks = 1;                     // ticks over which new nodes are created now
  double listed_split_m = 0;   // split distance of the coarsest level when the windows were listed
  core::BlockCoord listed_at;  // the camera's block then
  NodeCounts counts;
};

// Bundle: everything that decides which meshes a camera needs.
struct StreamingContext {
  FrameContext frame;
  const Camera& camera;
  const Quality& quality;
  const WorldFacts& facts;
  const Daylight& daylight;
};

// System: creates and destroys nodes with their models around the camera.
void streaming_system(StreamingContext context, Streaming& streaming, NodeWork work);

// The fraction of sunlight at a position: that of the finest node there, or 1 without a node.
// `entities`: a query that reads GroundSunlight.
template <class Query>
float ground_sun_at(core::WorldPosition at, double block_size_m, const Streaming& streaming,
                    const Query& entities) {
  at = core::normalised(at, block_size_m);
  for (const NodeGrid& grid : streaming.grids) {
    const visibility::NodeCoord node = visibility::node_of(at.block, grid.level());
    if (!grid.contains(node.coord)) continue;
    const GroundSunlight* sun = entities.template get<GroundSunlight>(grid.entity_of(node.coord));
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
