// A patch of grass: tufts of bent blades on ground that may slope, with or without flowers. Plain
// triangles, no textures and no growth. Blades extend below the ground, so uneven ground shows no
// gaps. Not visible from far away: merged meshes and the colour of far ground omit it.
// docs/models.md, "Grass".
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices into kGrassSchema.
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

// The schema of the type "grass", by GrassParameter.
inline constexpr ParameterSpec kGrassSchema[] = {
    placed(integer_parameter("seed", "", 1, {-0x1.0p63, 0x1.0p63}, {0, 1000},
                             "selects one of all patches")),
    placed(real_parameter("slope_x", "1", 0, {-1.5, 1.5}, {-0.6, 0.6},
                          "of the ground, rise per metre along x")),
    placed(real_parameter("slope_z", "1", 0, {-1.5, 1.5}, {-0.6, 0.6},
                          "of the ground, rise per metre along z")),
    integer_parameter("blades", "", 120, {1, 4096}, {20, 400}, "number of blades"),
    integer_parameter("flowers", "", 0, {0, 1024}, {0, 40}, "number of flowers"),
    real_parameter("radius_m", "m", 1, {0.01, 20}, {0.2, 2.5}, "of the patch"),
    real_parameter("height_m", "m", 0.35, {0.01, 5}, {0.08, 0.9}, "of the highest blades"),
    real_parameter("width_m", "m", 0.025, {0.001, 1}, {0.008, 0.06}, "of a blade at its base"),
    real_parameter("lean", "1", 0.5, {0, 1.5}, {0.1, 1},
                   "shift of a blade's tip, relative to its height"),
    real_parameter("albedo", "1", 0.11, {0.01, 0.9}, {0.05, 0.3},
                   "mean reflected fraction of light"),
    real_parameter("dryness", "1", 0.1, {0, 1}, {0, 1}, "green (0) to straw (1)"),
    integer_parameter("flower", "", kWhiteFlower, {0, kFlowerCount - 1}, {0, kFlowerCount - 1},
                      "0 white, 1 yellow, 2 pink, 3 blue"),
};
static_assert(std::size(kGrassSchema) == kGrassParameterCount);

// The model type "grass". Level 0 has 3 triangles a blade and 3 + 4 a flower. Level 1 has one
// triangle for each blade and each flower. Levels 2 and 3 keep a third and a ninth of these,
// widened to cover the same area. Meshes have their own indices. Scalar code: about 0.25 µs a blade
// of level 0 (psygen amplify of a world that has only grass).
std::unique_ptr<ModelType> make_grass_type();

}  // namespace psygen::models
