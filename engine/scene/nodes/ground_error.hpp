// How far the ground that nodes draw is off, measured at some nodes of a world. The bound that
// follows from the parameters (ModelType::level_error_m) is several times as large where cells are
// small: octaves seldom add up. Pure: the same for a world everywhere.
#pragma once

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// In metres, of nodes of a level that draw level 1 of the terrain type: the vertical distance to
// level 0 that 95 % of its vertices stay within; sharp ridges lie beyond it. Synthesises 16
// nodes.
double measured_ground_error_m(const world::World& world, const models::Registry& registry,
                               int node_level);

}  // namespace psygen::scene
