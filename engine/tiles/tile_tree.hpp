// A region as an implicit quadtree of 3D Tiles 1.1: its tiles, the node of the engine's quadtree
// that each shows, and their positions. Level 0 is the root; tiles count east and north from the
// root's south-west corner. Pure values; any thread. Knows no meshes and no files.
#pragma once

#include <cstdint>

#include "engine/amplify/region.hpp"

namespace psygen::tiles {

// Levels of nodes: a node of level k covers 2^k × 2^k blocks. Level 0 is a block with full detail.
struct NodeLevels {
  int finest = 0, coarsest = 0;
};
inline constexpr int kMaxNodeLevel = 20;
// Parses "FINEST-COARSEST", or one number for both: 0 … kMaxNodeLevel. Fails with kInvalidArgument.
core::Result<NodeLevels> parse_levels(std::string_view text);

// A tile by its coordinates in the tileset.
struct Tile {
  int level = 0;
  std::uint32_t x = 0, y = 0;
};

class TileTree {
 public:
  // The smallest square of nodes that covers the region, with its corner at a node of the coarsest
  // level. Fails with kInvalidArgument if it extends beyond the range of block coordinates or has
  // more than kMaxNodeLevel levels.
  static core::Result<TileTree> over(const amplify::Region& region, NodeLevels levels);

  const amplify::Region& region() const { return region_; }
  NodeLevels node_levels() const { return levels_; }
  // Number of levels of tiles, including the root; and blocks along a side of the root.
  int level_count() const { return depth_ - levels_.finest + 1; }
  std::uint64_t side_blocks() const { return std::uint64_t{1} << depth_; }
  // The north-west corner, the origin of the tileset.
  core::BlockCoord corner() const { return corner_; }

  int node_level(const Tile& tile) const { return depth_ - tile.level; }
  // The tile's node, in units of its level. Requires node_level(tile) <= node_levels().coarsest.
  core::BlockCoord node(const Tile& tile) const;
  // Blocks from the root's north-west corner to the tile's: east, and south.
  std::uint64_t east(const Tile& tile) const;
  std::uint64_t south(const Tile& tile) const;
  // True if a tile shows ground of the region; true if it has a file. Coarse tiles extend beyond a
  // region whose border is not at a multiple of their side.
  bool exists(const Tile& tile) const;
  bool has_content(const Tile& tile) const;

 private:
  amplify::Region region_;
  NodeLevels levels_;
  core::BlockCoord corner_;
  int depth_ = 0;  // node level of the root
};

}  // namespace psygen::tiles
