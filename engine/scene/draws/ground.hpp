// What is drawn of the ground of a node: those of its tiles that are in view and not behind the
// horizon, and the skirts that face the camera. Of a block's finest ground the near tiles are drawn
// in all their cells, the others in those of the next level. Nothing pops: by where a tile changes,
// all its vertices have morphed.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Over which distances a block's finest ground takes the shape of the next level.
render::Morph morph_of(const Streaming& streaming);

// The tiles of a node, as boxes relative to the camera.
struct NodeTiles {
  const models::TerrainGrid& grid;  // of the node's mesh
  const GroundRelief& relief;       // of the same
  glm::vec3 corner{0.0F};           // of the node, at height 0
  float cell_m = 1, low_m = 0;      // of the grid at its finest; below all ground and its skirts

  // The box of a tile with its skirt.
  core::Bounds box(int column, int row) const;
};

// Bit row · side + column is set for tiles that can be seen. All of them, and all skirts, where
// what is not in the picture matters too: it may cast a shadow, or the world's edge moves it.
inline constexpr std::uint32_t kAllTiles = UINT32_MAX;
std::uint32_t tiles_in_view(const NodeTiles& tiles, const View& view);

// Adds draws for these tiles. `draw` is that of the whole node. `fine`: it has the index list of
// tiles in two kinds; those nearer than `fine_m`, seen from above, are fine.
void add_tiles(const NodeTiles& tiles, std::uint32_t in_view, const models::TerrainTiles* fine,
               float fine_m, render::TerrainDraw draw, std::vector<render::TerrainDraw>& draws);

}  // namespace psygen::scene
