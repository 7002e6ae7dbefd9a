// The blocks of a node in Morton order, and the ground under them: in square tiles of blocks, which
// follow each other in the same order, and as it is drawn. Pure functions.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A block, its place in the order, and where its corner is, in metres.
struct NodeBlock {
  core::BlockCoord coord;
  std::uint64_t ordinal = 0;
  glm::dvec2 in_node_m{0.0}, in_tile_m{0.0};
};

// Level of the nodes that are tiles: ground of 1 m lattices (where that is the terrain's) for nodes
// of 1 and 2, then twice as wide with each level. So no node has more than 16 tiles.
constexpr int tile_level(int node_level) {
  return node_level <= 2 ? 0 : node_level - 2;
}
constexpr std::uint32_t ground_tiles(int node_level) {
  return 1U << (2 * (node_level - tile_level(node_level)));
}

// The level of the terrain type that nodes of levels 1 and more draw.
int node_mesh_level(const World& world);

class NodeWalk {
 public:
  // `node` is counted in nodes of its level, 1 … 15. Blocks beyond 2^31 wrap. `world` must outlive
  // it.
  NodeWalk(const World& world, core::BlockCoord node, int node_level);

  std::uint32_t block_count() const { return 1U << (2 * level_); }
  NodeBlock block(std::uint32_t ordinal) const;
  // Whether a block is the first of its tile.
  bool starts_tile(std::uint32_t ordinal) const {
    return (ordinal & ((1U << (2 * tile_)) - 1)) == 0;
  }
  // Makes the ground of the tile that a block lies on.
  void make_ground(std::uint32_t ordinal, std::optional<models::BlockGround>& out) const;
  // The ground of the whole node, and the stride with which at() gives what is drawn of it.
  models::BlockGround whole_ground() const;
  int drawn_stride() const;

 private:
  const World& world_;
  core::BlockCoord node_;
  int level_, tile_;
};

}  // namespace psygen::world
