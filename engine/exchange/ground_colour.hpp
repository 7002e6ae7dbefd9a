// The albedo of the ground as shaders/ground.glsl colours it: by height, slope and a slow pattern
// over the plane. Pure.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/world/world.hpp"

namespace psygen::exchange {

// Metres after which the pattern repeats along each axis.
inline constexpr double kGroundPatternPeriodM = 2048;

// Where a point of `block` lies in the pattern; `local_m` is metres from the block's corner.
glm::vec2 pattern_place(core::BlockCoord block, double block_size_m, glm::vec2 local_m);

// Linear albedo. `packed_height` is the vertex's (core::TerrainVertex::height); it seeds the grain.
glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height);

}  // namespace psygen::exchange
