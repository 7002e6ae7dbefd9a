// The geometric error of drawn ground, measured at some nodes of a world. The bound that follows
// from the parameters (ModelType::level_error_m) is several times as large where cells are small,
// because octaves seldom add up. Pure: the same for a world everywhere.
#pragma once

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// The error in metres of nodes of a level that draw level 1 of the terrain type: 95 % of the
// vertices lie within this vertical distance of level 0; sharp ridges lie beyond it. Synthesises 16
// nodes.
double measured_ground_error_m(const world::World& world, const models::Registry& registry,
                               int node_level);

}  // namespace psygen::scene
