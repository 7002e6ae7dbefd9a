// The nodes that exist as entities: one for each node of the quadtree that may be drawn soon, and
// one for each model on it. Created and destroyed in batches, coarse nodes before fine ones and
// nearest first, within a time budget per tick. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/nodes/daylight.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/nodes/ground_patches.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// The window of nodes of one level that may exist as entities: a square of side × side nodes around
// the camera. Its table is addressed modulo a power of two, so moving the window touches only nodes
// that enter or leave it, and node coordinates may wrap. Holds handles, not data.
class NodeGrid {
 public:
  // A window of 2 · radius + 1 nodes of `level` along each side, its maximum size.
  explicit NodeGrid(std::uint8_t level = 0, std::uint32_t radius = 0);

  // The level, the number of nodes from the middle to a side, and the side.
  std::uint8_t level() const { return level_; }
  std::uint32_t radius() const { return radius_; }
  std::uint32_t side() const { return 2 * radius_ + 1; }
  // Sets the radius, at most max_radius(). Destroy nodes outside the new window before any look-up
  // of their cells.
  void set_radius(std::uint32_t radius) { radius_ = radius; }
  std::uint32_t max_radius() const { return max_radius_; }
  visibility::NodeCoord centre() const { return centre_; }
  void set_centre(core::BlockCoord block) { centre_ = visibility::node_of(block, level_); }

  // The node at window position (column, row), each 0 … side − 1.
  visibility::NodeCoord node_at(std::uint32_t column, std::uint32_t row) const;
  // row · side + column of a node in the window.
  std::size_t window_index(core::BlockCoord coord) const;
  // True if the node lies in the window.
  bool contains(core::BlockCoord coord) const;
  // The entity of a node in the window; null if there is none.
  ecs::Entity& entity_of(core::BlockCoord coord);
  ecs::Entity entity_of(core::BlockCoord coord) const;

 private:
  std::uint32_t column_of(std::int32_t index, std::int32_t centre) const;
  std::size_t cell_of(core::BlockCoord coord) const;

  std::uint8_t level_;
  std::uint32_t radius_, max_radius_;
  std::uint32_t mask_;
  visibility::NodeCoord centre_;
  std::vector<ecs::Entity> cells_;
};

// The windows of a world, one for each level, at their largest.
std::vector<NodeGrid> node_grids(const SceneSettings& settings, const WorldFacts& facts);

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

// System: creates and destroys nodes with their models around the camera. Nodes wait for the
// patches that their ground reads.
void streaming_system(StreamingContext context, Streaming& streaming, GroundPatches& patches,
                      NodeWork work);

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
