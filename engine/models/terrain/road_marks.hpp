// Marks the vertices of a terrain mesh that are on roads (TerrainVertex::road), so that the shader
// draws them as road. Pure, any thread. It moves no heights (ground_edits.hpp). Internal to the
// terrain.
#pragma once

#include <cstddef>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/shape.hpp"

namespace psygen::models {

// Writes the marks of all surface vertices where roads pass the node, and no others. `vertices` is
// a whole mesh; it is only written to. Linear in the vertices near roads.
void mark_roads(const TerrainShape& shape, const TerrainGrid& grid, core::BlockCoord node,
                std::byte* vertices);

}  // namespace psygen::models
