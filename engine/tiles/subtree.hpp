// Subtrees of implicit tiling as files: which of the tiles below a tile exist, which have content,
// where the next subtrees are, and the box of each tile (3D Tiles 1.1, "Subtrees" and "Metadata").
// Pure; any thread.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "engine/tiles/tile_tree.hpp"

namespace psygen::tiles {

// Levels of tiles in a subtree, but in the last ones.
inline constexpr int kSubtreeLevels = 5;

// A box as 3D Tiles write it: its centre and three half axes, z up, metres from the corner.
using TileBox = std::array<double, 12>;

// The bytes of the subtree whose root is `root`. `box_of` is asked for every tile that exists.
std::string subtree_bytes(const TileTree& tree, const Tile& root,
                          const std::function<TileBox(const Tile&)>& box_of);

// The schema of a tileset of such subtrees, as a member of its JSON.
extern const char* const kSchema;

}  // namespace psygen::tiles
