// The albedo of the ground, the same as in shaders/ground.glsl: the colours of the kinds of ground
// (world/ground_blends.hpp), with grain. Pure, any thread, constant time. It knows no meshes
// (unpack.hpp).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/world/world.hpp"

namespace psygen::exchange {

// Linear albedo of a point. `pattern_place_m` comes from world::pattern_place(). `normal` has unit
// length; `packed_height` is core::TerrainVertex::height and seeds the grain; `road` is
// TerrainVertex::road, 0 … 1.
glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height, float road = 0.0F);

}  // namespace psygen::exchange
