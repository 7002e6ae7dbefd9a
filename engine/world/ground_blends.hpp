// Which kinds of ground a point has: by height, slope and a slow pattern over the plane. The same
// rule as in shaders/ground.glsl (ground_blends_test.cpp runs the shader's text against this one),
// without far forests and grain. Pure, any thread, constant time. Knows no meshes.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The kinds of ground, in the order in which each covers those before it.
enum class GroundKind : std::uint8_t { kGrass, kForest, kDry, kSand, kRock, kSnow };
inline constexpr std::size_t kGroundKinds = 6;

// How much each kind covers of those before it, 0 … 1. Element 0 is 1.
using GroundBlends = std::array<float, kGroundKinds>;

// Metres after which the pattern repeats along each axis.
inline constexpr double kGroundPatternPeriodM = 2048;

// The place of a point in the pattern: metres in [0, kGroundPatternPeriodM). `local_m` is in metres
// from the corner of `block`.
glm::vec2 pattern_place(core::BlockCoord block, double block_size_m, glm::vec2 local_m);

// The blends of a point. `palette` is that of drawn_palette(); `normal` has unit length. `road`:
// how much of the ground is a road, 0 … 1; roads are rock and dry ground.
GroundBlends ground_blends(const Palette& palette, float height_m, const glm::vec3& normal,
                           glm::vec2 pattern_place_m, float road = 0.0F);

// Their names in world files, in the same order.
inline constexpr std::array<std::string_view, kGroundKinds> kGroundNames{"grass", "forest", "dry",
                                                                         "sand",  "rock",   "snow"};

// Of all that decides where each kind is, in worlds whose scatters ask for kinds of ground; 0 in
// all others. Colours decide nothing.
std::uint64_t placing_hash(const World& world);

// The kind with the largest share of what is seen: its blend times what later kinds leave of it.
// The first one of equals.
GroundKind main_kind(const GroundBlends& blends);

}  // namespace psygen::world
