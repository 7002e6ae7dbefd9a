// A rock: midpoint displacement on a tetrahedron (paper, section 5.2, eq. 1; docs/models.md,
// "Rock"). Watertight, outward-facing and around its own centre for all legal parameters; stands in
// the ground with its lower third. Vertices are shared, but for faceted rocks, whose triangles have
// vertices of their own.
#pragma once

#include <cstddef>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Positions in the schema of the type "rock".
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

// Level l has max(subdivisions − l, 0) subdivisions: 4·4^n triangles exactly and 2·4^n + 2
// core::ModelVertex, or three a triangle where faceted. Corners that two levels share have the same
// places. Needs 700 KiB of stack; nothing on the heap.
std::unique_ptr<ModelType> make_rock_type();

}  // namespace psygen::models
