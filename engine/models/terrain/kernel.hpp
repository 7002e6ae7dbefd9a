// The seam between a terrain block (terrain.cpp) and the SIMD kernel that turns its noise into
// packed vertices (kernel.cpp), compiled once for every instruction set. Not for other
// files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::models {

// The samples whose triangles the coarse heights lie on: (i, k) is
// first[(k · row_stride + i) · step], at the vertex (i · ratio − phase_x, k · ratio − phase_z) of
// the level. They reach to the level's ends or beyond.
struct CoarseSamples {
  const float* first;
  std::size_t row_stride;
  std::size_t step;
  std::size_t ratio;             // cells of the level in one of these
  std::size_t phase_x, phase_z;  // less than ratio
};

// Light in [0, 255] at points `spacing` cells apart, `phase` cells before the first vertex; also at
// the ends and one point beyond. Rows may be read 16 points beyond that.
struct LightSamples {
  const float *sun, *ambient;
  std::size_t row_stride;
  std::size_t spacing;
  std::size_t phase_x, phase_z;  // less than spacing
};

// A level of a block. Vertex (x, z) has the sample first[(z · row_stride + x) · step]; the samples
// next to it, one cell away, exist as well, and every row may be read 16 samples beyond its end.
struct TerrainSurface {
  const float* first;
  std::size_t row_stride;
  std::size_t step;
  std::size_t n;       // vertices per side
  std::size_t stride;  // grid distance of neighbouring vertices
  CoarseSamples coarse;
  LightSamples light;
  float quantum;      // noise → quantised height
  float slope_scale;  // difference of the samples on two sides → slope
};

struct HeightRange {
  std::uint16_t lowest, highest;
};

// Writes n² vertices of the surface, row by row, and the 4 · (n − 1) of the skirt (docs/models.md,
// "Mesh"). Only writes to `out`, which needs no alignment. 0.5 ns a vertex with AVX-512.
HeightRange pack_terrain(const TerrainSurface& surface, std::byte* out);

}  // namespace psygen::models
