// The window of nodes of one level that may exist as entities: a square of side × side nodes around
// the camera. Its table is addressed modulo a power of two, so moving the window touches only nodes
// that enter or leave it, and node coordinates may wrap. Holds handles, not data. Main thread.
#pragma once

#include <cstdint>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

struct SceneSettings;
struct WorldFacts;

// The window of one level.
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

}  // namespace psygen::scene
