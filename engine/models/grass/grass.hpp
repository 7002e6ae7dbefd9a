// A patch of grass: tufts of bent blades on ground that may slope, with or without flowers. Plain
// triangles, no textures and no growth. Blades extend below the ground, so uneven ground shows no
// gaps. Not visible from far away: merged meshes and the colour of far ground omit it.
// docs/models.md, "Grass".
#pragma once

#include <cstddef>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices into the schema of the type "grass".
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

// The model type "grass". Level 0 has 3 triangles a blade and 3 + 4 a flower. Level 1 has one
// triangle for each blade and each flower. Levels 2 and 3 keep a third and a ninth of these,
// widened to cover the same area. Meshes have their own indices. Scalar code: about 0.25 µs a blade
// of level 0 (psygen amplify of a world that has only grass).
std::unique_ptr<ModelType> make_grass_type();

}  // namespace psygen::models
