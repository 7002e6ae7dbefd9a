// The blocks of a node in Morton order, and the ground under them. The ground is evaluated in
// square tiles of blocks in the same order, and for the whole node as it is drawn. Tiles are
// without edits, because models find their positions there; stamps and roads are part of the world.
// Pure functions, any thread. Places no models.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A block, its index in Morton order, and the position of its corner in the node and in its tile,
// in metres.
struct NodeBlock {
  core::BlockCoord coord;
  std::uint64_t ordinal = 0;
  glm::dvec2 in_node_m{0.0}, in_tile_m{0.0};
};

// Node level of the tiles of a node. Nodes of levels 1 and 2 use the terrain's own lattice (such as
// 1 m). So do all levels if heights are cheap (no warp, erosion or rivers) and a scatter has
// limits: far instances then stand exactly where near ones do. Other nodes double the spacing with
// each level from 3 on and have at most 16 tiles, or 4, the grounds of the nodes below, with
// erosion or rivers.
int tile_level(const World& world, int node_level);
// Number of tiles of a node, 1 … 4^node_level.
std::uint32_t ground_tiles(const World& world, int node_level);

// The level of detail of the terrain that nodes of level 1 and above draw.
int node_mesh_level(const World& world);

// The walk over one node.
class NodeWalk {
 public:
  // `node` is in nodes of its level, 1 … 15. Block coordinates beyond 2^31 wrap around. `world`,
  // which must have no edits, must outlive it.
  NodeWalk(const World& world, core::BlockCoord node, int node_level);

  // Number of blocks; and the block with an index below it.
  std::uint32_t block_count() const { return 1U << (2 * level_); }
  NodeBlock block(std::uint32_t ordinal) const;
  // True if a block is the first one of its tile.
  bool starts_tile(std::uint32_t ordinal) const {
    return (ordinal & ((1U << (2 * tile_)) - 1)) == 0;
  }
  // Makes the ground of the tile with this block, for so many questions (BlockGround).
  void make_ground(std::uint32_t ordinal, std::size_t questions,
                   std::optional<models::BlockGround>& out) const;
  // The ground of the whole node with these edits (null: without), which must outlive it; and the
  // stride for BlockGround::at() that gives the drawn ground.
  models::BlockGround whole_ground(const models::EditLayer* edits) const;
  int drawn_stride() const;

 private:
  const World& world_;
  core::BlockCoord node_;
  int level_, tile_;
};

}  // namespace psygen::world
