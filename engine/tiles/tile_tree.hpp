// A region as an implicit quadtree of 3D Tiles 1.1: which tiles there are, which node of the
// engine's quadtree each shows, and where it lies. Level 0 is the root; tiles count east and north
// from the root's south-west corner. Pure values; any thread. Knows no meshes and no files.
#pragma once

#include <cstdint>

#include "engine/amplify/region.hpp"

namespace psygen::tiles {

// Levels of nodes: a node of level k covers 2^k × 2^k blocks. Level 0 is a block with all details.
struct NodeLevels {
  int finest = 0, coarsest = 0;
};
inline constexpr int kMaxNodeLevel = 20;
// Parses "FINEST-COARSEST", or one number for both: 0 … kMaxNodeLevel. Fails with kInvalidArgument.
core::Result<NodeLevels> parse_levels(std::string_view text);

// A tile by its numbers in the tileset.
struct Tile {
  int level = 0;
  std::uint32_t x = 0, y = 0;
};

class TileTree {
 public:
  // The smallest square of nodes that holds the region, with its corner at a node of the coarsest
  // level. Fails with kInvalidArgument if it reaches beyond all blocks or has more than
  // kMaxNodeLevel levels.
  static core::Result<TileTree> over(const amplify::Region& region, NodeLevels levels);

  const amplify::Region& region() const { return region_; }
  NodeLevels node_levels() const { return levels_; }
  // Number of levels of tiles, the root's included; and blocks along a side of the root.
  int level_count() const { return depth_ - levels_.finest + 1; }
  std::uint64_t side_blocks() const { return std::uint64_t{1} << depth_; }
  // Its north-west corner, to which everything in the tileset is relative.
  core::BlockCoord corner() const { return corner_; }

  int node_level(const Tile& tile) const { return depth_ - tile.level; }
  // The tile's node, in units of its level. Requires node_level(tile) <= node_levels().coarsest.
  core::BlockCoord node(const Tile& tile) const;
  // Blocks from the root's north-west corner to the tile's, east and south.
  std::uint64_t east(const Tile& tile) const;
  std::uint64_t south(const Tile& tile) const;
  // Whether a tile shows ground of the region, and whether it has a file: coarse tiles reach
  // beyond the region where its border is not at a multiple of their side.
  bool exists(const Tile& tile) const;
  bool has_content(const Tile& tile) const;

 private:
  amplify::Region region_;
  NodeLevels levels_;
  core::BlockCoord corner_;
  int depth_ = 0;  // level of the root as a node
};

}  // namespace psygen::tiles
