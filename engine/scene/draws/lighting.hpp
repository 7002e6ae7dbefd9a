// A world file's sky and ground in the renderer's terms. Pure.
#pragma once

#include <optional>

#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// Sun and sky of the file, moved on to `time_s` of its day. The haze of the file, or more where it
// takes more to hide what lies beyond `view_distance_m`.
render::Light light_of(const world::World& world, double view_distance_m, double time_s = 0);
// Puts sun and sky of `light`, made by light_of, where they are at `time_s`.
void move_sun(const world::World& world, double time_s, render::Light& light);
std::optional<render::WaterSurface> water_of(const world::World& world);
render::TerrainPalette palette_of(const world::World& world);
// Where the world's plants may stand, in the colour that they have from above.
render::Canopy canopy_of(const world::World& world, const glm::vec3& albedo);
// The rectangle of a finite world, seen from the camera.
render::WorldEdge edge_of(const world::World& world, const core::WorldPosition& camera);

}  // namespace psygen::scene
