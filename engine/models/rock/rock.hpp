// A rock: midpoint displacement on a tetrahedron (paper, section 5.2, eq. 1; docs/models.md,
// "Rock"). Watertight, facing outwards and around its own centre for all legal parameters. Its
// lower third is in the ground. Triangles share vertices, except those of faceted rocks.
#pragma once

#include <cstddef>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices into the schema of the type "rock".
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

// The model type "rock". Level l has n = max(subdivisions − l, 0) subdivisions: exactly 4·4^n
// triangles and 2·4^n + 2 core::ModelVertex, or three per triangle if faceted. Corners that two
// levels share have the same positions. Synthesis needs 700 KiB of stack and no heap. The collider
// is the convex hull of the corners. With more than two subdivisions, it is the hull of the 56
// corners that are farthest in fixed directions, and other corners are outside by at most 0.15 of
// the radius.
std::unique_ptr<ModelType> make_rock_type();

}  // namespace psygen::models
