// The surface of a world: its ground, or the water that covers it. Pure, any thread. It knows no
// meshes; exact questions about what is drawn are for engine/query.
#pragma once

#include <algorithm>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The height of the ground at a place, or of the water on it, in metres of the world. The place's
// own height is ignored.
inline double surface_height_m(const World& world, const core::WorldPosition& at) {
  const double ground_m = models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
  return world.water.exists() ? std::max(ground_m, world.water.level_m) : ground_m;
}

}  // namespace psygen::world
