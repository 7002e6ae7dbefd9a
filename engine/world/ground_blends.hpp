// The kinds of ground at a point, by height, slope and a slow pattern over the plane. The rule is
// that of shaders/ground.glsl without far forests and grain; ground_blends_test.cpp compares the
// two. Pure, any thread, constant time. Knows no meshes.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The kinds of ground. Each covers the kinds before it.
enum class GroundKind : std::uint8_t { kGrass, kForest, kDry, kSand, kRock, kSnow };
inline constexpr std::size_t kGroundKinds = 6;

// The fraction of the earlier kinds that each kind covers, 0 … 1. Element 0 is 1.
using GroundBlends = std::array<float, kGroundKinds>;

// Period of the pattern along each axis, in metres.
inline constexpr double kGroundPatternPeriodM = 2048;

// The position of a point in the pattern: metres in [0, kGroundPatternPeriodM). `local_m` is in
// metres from the corner of `block`.
glm::vec2 pattern_place(core::BlockCoord block, double block_size_m, glm::vec2 local_m);

// The blends of a point. `palette` comes from drawn_palette(); `normal` has unit length. `road` is
// the fraction of the ground that is road, 0 … 1; roads are rock and dry ground.
GroundBlends ground_blends(const Palette& palette, float height_m, const glm::vec3& normal,
                           glm::vec2 pattern_place_m, float road = 0.0F);

// The names of the kinds in world files, in the same order.
inline constexpr std::array<std::string_view, kGroundKinds> kGroundNames{"grass", "forest", "dry",
                                                                         "sand",  "rock",   "snow"};

// A hash of everything that decides the kind of ground at a point, for worlds whose scatters select
// kinds of ground; otherwise 0. Colours do not matter.
std::uint64_t placing_hash(const World& world);

// The kind with the largest visible fraction: its blend times the uncovered rest of the later
// kinds. Of equals the first.
GroundKind main_kind(const GroundBlends& blends);

}  // namespace psygen::world
