// The surface of the rivers and lakes of a node, as a mesh of core::WaterVertex: strips along
// rivers, and tiles of lakes. It is made from the pieces in the ground's layers (ground/water.hpp)
// and from the river network, so it is a pure function of its parameters. Each strip and each tile
// belongs to the node that has its middle; neighbouring ones share their ends.
#pragma once

#include <memory>

#include "engine/models/edits.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices of the parameters. The edits of the parameters hold the water.
enum WaterParameter : std::size_t { kWaterX, kWaterZ, kWaterNodeLevel, kWaterBlockM };

// Parameters of the water of a node, which is counted in squares of its level. They name no edits
// yet.
Parameters water_surface_parameters(core::BlockCoord node, int node_level, double block_m);

// True if the mesh of these parameters, which name their edits, has any triangle. O(log n) without
// water.
bool has_water_surface(const Parameters& p);

// The type of these meshes. Pure, any thread.
std::unique_ptr<ModelType> make_water_type();

}  // namespace psygen::models
