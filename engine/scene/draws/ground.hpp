// Draws of the ground of a node: the tiles in view and not behind the horizon, and the skirts that
// face the camera. Near tiles of a block's finest ground are drawn with all cells, others with the
// cells of the next level. There is no popping: where a tile changes, all its vertices have
// morphed.
#pragma once

#include <vector>

#include "engine/models/terrain/tiles.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/scene/view/view.hpp"

namespace psygen::scene {

// The distances over which a block's finest ground morphs into the next level.
render::Morph morph_of(const Streaming& streaming);

// The tiles of a node, as boxes relative to the camera.
struct NodeTiles {
  const models::TerrainGrid& grid;  // of the node's mesh
  const GroundOccluder& occluder;   // of that mesh
  glm::vec3 corner{0.0F};           // of the node, at height 0
  float cell_m = 1,
        low_m = 0;  // side of a cell of the finest grid; height below all ground and its skirts

  // The box of a tile with its skirt.
  core::Bounds box(int column, int row) const;
};

// Sets bit row · side + column for tiles that may be visible. kAllTiles includes all skirts: for
// nodes whose shadows may fall into the frame, and nodes that the world's edge moves.
inline constexpr std::uint32_t kAllTiles = UINT32_MAX;
std::uint32_t tiles_in_view(const NodeTiles& tiles, const View& view);

// Adds draws for these tiles. `draw` is that of the whole node. `fine`: index lists of fine and
// coarse tiles; tiles nearer than `fine_m` in the horizontal plane are fine.
void add_tiles(const NodeTiles& tiles, std::uint32_t in_view, const models::TerrainTiles* fine,
               float fine_m, render::TerrainDraw draw, std::vector<render::TerrainDraw>& draws);

}  // namespace psygen::scene
