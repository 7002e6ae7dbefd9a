// The seam between the light of a terrain (light.cpp) and its SIMD kernel
// (light_kernel.cpp), compiled once for every instruction set. Not for other files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::models {

// Rays leave a point of a grid no further than this many points.
inline constexpr int kLightReach = 3;
// Points of a grid that lie between two of the next.
inline constexpr int kLightRatio = 4;
inline constexpr std::size_t kLightSteps = 4;

// A point on the way to the sun, in points of a grid: between `x`, `z` and the next ones.
struct LightStep {
  int x, z;
  float fraction_x, fraction_z;
  float length;
};

// The sun: slopes of rays to the lower and upper edges of its softened disc.
struct SunRays {
  std::array<LightStep, kLightSteps> steps;
  float low, high;
};

// Heights at points of one grid around a node, in any unit of length. The light is wanted at
// count_x · count_z of them; kLightReach further rows and columns lie on each side.
struct LightGrid {
  const float* heights;  // of the first row and column
  std::size_t stride;
  std::size_t count_x, count_z;
  std::size_t phase_x, phase_z;  // of the wanted ones from the first point wanted of the next grid
  float spacing;                 // of its points, in the same unit
  std::size_t sun_steps;         // steps that are taken, from the first
  bool sky;                      // whether the horizon is looked for
};

// Where light is written: in [0, 255], row by row.
struct LightOutput {
  float *sun, *ambient;
  std::size_t stride;  // at least count_x of the finest grid, rounded up to a multiple of 16
};

// Longest row of wanted points of the finest grid and of the others.
inline constexpr std::size_t kLightRow = 48, kLightCoarseRow = 16;

// The light at the points of grids[0] (docs/models.md, "Light"). Rows of heights may be read 16
// points beyond the last. `sun` may be null: everything is lit.
void light_terrain(const LightGrid* grids, std::size_t grid_count, const SunRays* sun,
                   const LightOutput& out);

}  // namespace psygen::models
