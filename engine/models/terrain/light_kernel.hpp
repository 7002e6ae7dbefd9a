// The seam between the light of a terrain (light.cpp) and its SIMD kernel (light_kernel.cpp), which
// is compiled once per instruction set. Internal to the terrain. Pure, any thread. docs/models.md,
// "Light".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::models {

// Rays from a point end at most this many points of the grid away.
inline constexpr int kLightReach = 3;
// Spacing of a grid's points over that of the next finer grid.
inline constexpr int kLightRatio = 4;
inline constexpr std::size_t kLightSteps = 4;

// A point on a ray to the sun, in points of a grid from the ray's origin: (x, z) plus the
// fractions.
struct LightStep {
  int x, z;
  float fraction_x, fraction_z;  // [0, 1)
  float length;                  // distance from the origin
};

// The sun: points along a ray, and the slopes of rays to the lower and the upper edge of its
// softened disc.
struct SunRays {
  std::array<LightStep, kLightSteps> steps;
  float low, high;
};

// Heights at points of one grid around a node, in any unit of length. Light is requested at count_x
// · count_z points, with kLightReach more rows and columns on each side.
struct LightGrid {
  const float* heights;  // from the first row and column on, including those beyond the requested
                         // points
  std::size_t stride;
  std::size_t count_x, count_z;
  std::size_t phase_x, phase_z;  // first requested point, counted from that of the next wider grid
  float spacing;                 // of its points, in the unit of the heights
  std::size_t sun_steps;         // number of SunRays::steps that are used
  bool sky;                      // true if this grid contributes to the horizon
};

// Destination of the light: in [0, 255], row by row.
struct LightOutput {
  float *sun, *ambient;
  std::size_t stride;  // at least count_x of the finest grid, rounded up to a multiple of 16
};

// Longest row of requested points of the finest grid and of the others.
inline constexpr std::size_t kLightRow = 48, kLightCoarseRow = 16;

// Writes the light at the requested points of grids[0], the finest; further grids are wider. 1 <=
// grid_count. Rows of heights may be read 16 points beyond the last. With `sun` null, everything is
// lit.
void light_terrain(const LightGrid* grids, std::size_t grid_count, const SunRays* sun,
                   const LightOutput& out);

}  // namespace psygen::models
