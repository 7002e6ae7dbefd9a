// Files of subtrees of implicit tiling: the existing tiles below a tile, those with content, the
// next subtrees, and the box of each tile (3D Tiles 1.1, "Subtrees" and "Metadata"). Pure; any
// thread.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "engine/tiles/tile_tree.hpp"

namespace psygen::tiles {

// Levels of tiles in a subtree, except the last ones.
inline constexpr int kSubtreeLevels = 5;

// A box in the notation of 3D Tiles: centre and three half axes, z up, metres from the corner.
using TileBox = std::array<double, 12>;

// The bytes of the subtree whose root is `root`. Calls `box_of` for every existing tile.
std::string subtree_bytes(const TileTree& tree, const Tile& root,
                          const std::function<TileBox(const Tile&)>& box_of);

// The schema of a tileset with such subtrees, as a member of its JSON.
extern const char* const kSchema;

}  // namespace psygen::tiles
