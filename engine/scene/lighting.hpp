// A world file's sky and ground in the renderer's terms. Pure.
#pragma once

#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// The haze of the file, or more where it takes more to hide what lies beyond `view_distance_m`.
render::Light light_of(const world::World& world, double view_distance_m);
render::TerrainPalette palette_of(const world::World& world);

}  // namespace psygen::scene
