// The albedo of the ground, the same as in shaders/ground.glsl: by height, slope and a slow pattern
// over the plane. Pure, any thread, constant time. It knows no meshes (unpack.hpp).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/world/world.hpp"

namespace psygen::exchange {

// Metres after which the pattern repeats along each axis.
inline constexpr double kGroundPatternPeriodM = 2048;

// The place of a point in the pattern: metres in [0, kGroundPatternPeriodM). `local_m` is in metres
// from the corner of `block`.
glm::vec2 pattern_place(core::BlockCoord block, double block_size_m, glm::vec2 local_m);

// Linear albedo of a point. `normal` has unit length; `packed_height` is
// core::TerrainVertex::height and seeds the grain.
glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height);

}  // namespace psygen::exchange
