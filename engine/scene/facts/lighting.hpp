// Converts a world's sky and ground to the renderer's types. Pure.
#pragma once

#include <optional>

#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// Sun and sky at `time_s` of the world's day. The haze is the world's, or denser if that is needed
// to hide the end of the view at `view_distance_m`.
render::Light light_of(const world::World& world, double view_distance_m, double time_s = 0);
// Moves sun and sky of `light`, which light_of() made, to `time_s`.
void move_sun(const world::World& world, double time_s, render::Light& light);
std::optional<render::WaterPlane> water_of(const world::World& world);
render::TerrainPalette palette_of(const world::World& world);
// The forests of the world in their colour from above.
render::Canopy canopy_of(const world::World& world, const glm::vec3& albedo);
// The borders of a finite world, relative to the camera.
render::WorldEdge edge_of(const world::World& world, const core::WorldPosition& camera);

}  // namespace psygen::scene
