// The surface of a world: its ground, or the water that covers it. Pure, any thread. It knows no
// meshes; engine/query answers exact questions about drawn ground.
#pragma once

#include <algorithm>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The height of the ground at a position, or of the water above it, in metres of the world. The
// position's own height is ignored.
inline double surface_height_m(const World& world, const core::WorldPosition& at) {
  const double ground_m = models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
  return world.water.exists() ? std::max(ground_m, world.water.level_m) : ground_m;
}

}  // namespace psygen::world
