// A patch of grass: tufts of bent blades on a piece of ground that may slope, perhaps with flowers.
// Nothing but triangles: no textures, no growth. Standing in the ground, so that uneven ground
// shows no gaps. Not seen from far: merged meshes and the colour of far ground leave it out.
// docs/models.md, "Grass".
#pragma once

#include <cstddef>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Positions in the schema of the type "grass".
enum GrassParameter : std::size_t {
  kGrassSeed = 0,
  kGrassSlopeX,  // of the ground, rise per metre
  kGrassSlopeZ,
  kGrassBlades,
  kGrassFlowers,
  kGrassRadiusM,
  kGrassHeightM,
  kGrassWidthM,
  kGrassLean,
  kGrassAlbedo,
  kGrassDryness,
  kGrassFlower,
  kGrassParameterCount
};

// Values of kGrassFlower.
enum GrassFlower : int { kWhiteFlower = 0, kYellowFlower, kPinkFlower, kBlueFlower, kFlowerCount };

// Level 0 has blades of 3 triangles and flowers of 3 + 4, level 1 one triangle for each of either;
// levels 2 and 3 a third and a ninth of those, broader by so much. Own indices. Scalar code: about
// 0.25 µs a blade of level 0 (psygen amplify of a world of nothing else).
std::unique_ptr<ModelType> make_grass_type();

}  // namespace psygen::models
