// How the finest ground of a block is drawn: its near tiles in all their cells, the others in those
// of the next level. Nothing pops: by where a tile changes, all its vertices have morphed.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Over which distances a block's finest ground takes the shape of the next level.
render::Morph morph_of(const Streaming& streaming);

// Adds a draw for each tile of a block that is in view and not behind the horizon (or `all`, where
// they cast shadows into the picture), and one for its skirts. `draw` is that of the whole block;
// its ground lies between `low_m` and `high_m` (relative to draw.origin); nearer than `fine_m`,
// seen from above, tiles are fine.
void add_tiles(const models::TerrainTiles& tiles, const View& view, float low_m, float high_m,
               float fine_m, bool all, render::TerrainDraw draw,
               std::vector<render::TerrainDraw>& draws);

}  // namespace psygen::scene
