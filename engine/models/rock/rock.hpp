// A rock: midpoint displacement on a tetrahedron (paper, section 5.2, eq. 1; docs/models.md,
// "Rock"). Watertight, facing outwards and around its own centre for all legal parameters. Its
// lower third is in the ground. Triangles share vertices, except those of faceted rocks.
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices into kRockSchema.
enum RockParameter : std::size_t {
  kRockSeed = 0,
  kRockSubdivisions,
  kRockRadiusM,
  kRockAmplitude,
  kRockDecay,
  kRockAlbedo,
  kRockWarmth,
  kRockMoss,
  kRockFamily,
  kRockParameterCount
};

// Values of kRockFamily.
enum RockFamily : int { kRockRounded = 0, kRockFaceted, kRockLayered, kRockFamilyCount };

inline constexpr int kMaxSubdivisions = 6;

// The schema of the type "rock", by RockParameter.
inline constexpr ParameterSpec kRockSchema[] = {
    placed(integer_parameter("seed", "", 1, {-0x1.0p63, 0x1.0p63}, {0, 1000},
                             "selects one of all rocks")),
    integer_parameter("subdivisions", "", 2, {0, kMaxSubdivisions}, {0, 4},
                      "number of times that every triangle is split into four"),
    real_parameter("radius_m", "m", 0.6, {0.01, 100}, {0.1, 4}, "mean radius"),
    real_parameter("amplitude", "1", 0.24, {0, 0.6}, {0, 0.4},
                   "roughness: displacement relative to the radius"),
    real_parameter("decay", "1", 0.55, {0, 1}, {0.3, 0.9},
                   "ratio of the displacements of two subdivisions"),
    real_parameter("albedo", "1", 0.26, {0.02, 0.9}, {0.1, 0.5},
                   "mean reflected fraction of light"),
    real_parameter("warmth", "1", 0.25, {-1, 1}, {-0.5, 0.7}, "blue-grey (-1) to red-brown (1)"),
    real_parameter("moss", "1", 0.3, {0, 1}, {0, 1}, "cover of moss on surfaces that face up"),
    integer_parameter("family", "", kRockRounded, {0, kRockFamilyCount - 1},
                      {0, kRockFamilyCount - 1}, "0 rounded, 1 faceted, 2 layered"),
};
static_assert(std::size(kRockSchema) == kRockParameterCount);

// The model type "rock". Level l has n = max(subdivisions − l, 0) subdivisions: exactly 4·4^n
// triangles and 2·4^n + 2 core::ModelVertex, or three per triangle if faceted. Corners that two
// levels share have the same positions. The collider
// is the convex hull of the corners. With more than two subdivisions, it is the hull of the 56
// corners that are farthest in fixed directions, and other corners are outside by at most 0.15 of
// the radius.
std::unique_ptr<ModelType> make_rock_type();

}  // namespace psygen::models
