// The eight directions of a compass, as unit vectors of x and z: from +X over +Z, each 45° on.
#pragma once

#include <array>
#include <glm/vec2.hpp>

namespace psygen::world {

inline constexpr double kDiagonal = 0.70710678118654752;
inline constexpr std::array<glm::dvec2, 8> kCompass{{{1, 0},
                                                     {kDiagonal, kDiagonal},
                                                     {0, 1},
                                                     {-kDiagonal, kDiagonal},
                                                     {-1, 0},
                                                     {-kDiagonal, -kDiagonal},
                                                     {0, -1},
                                                     {kDiagonal, -kDiagonal}}};

}  // namespace psygen::world
