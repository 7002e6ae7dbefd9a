// The seam between a terrain block (terrain.cpp) and the SIMD kernel that turns its noise into
// packed vertices (kernel.cpp), which is compiled once per instruction set. Internal to the
// terrain. Pure, any thread, linear in the vertices. docs/models.md, "Mesh".
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::models {

// The samples whose triangles define the coarse heights. Sample (i, k) is
// first[(k · row_stride + i) · step], at vertex (i · ratio − phase_x, k · ratio − phase_z) of the
// level. The samples reach the level's ends or lie beyond.
struct CoarseSamples {
  const float* first;
  std::size_t row_stride;
  std::size_t step;
  std::size_t ratio;             // cells of the level per cell of these samples
  std::size_t phase_x, phase_z;  // less than ratio
};

// Light in [0, 255] at points `spacing` cells apart. The first point lies `phase` cells before the
// first vertex, the last one beyond the last vertex. Rows may be read 16 points further.
struct LightSamples {
  const float *sun, *ambient;
  std::size_t row_stride;
  std::size_t spacing;
  std::size_t phase_x, phase_z;  // less than spacing
};

// A level of a block. Vertex (x, z) has the sample first[(z · row_stride + x) · step]. The samples
// one cell away on its four sides exist too, and every row may be read 16 samples beyond its end.
// All pointers must stay valid during the call.
struct TerrainSurface {
  const float* first;
  std::size_t row_stride;
  std::size_t step;
  std::size_t n;       // vertices per side
  std::size_t stride;  // grid distance of neighbouring vertices
  CoarseSamples coarse;
  LightSamples light;
  float quantum;      // quantised height of noise 1
  float slope_scale;  // slope for a difference of 1 between the samples on opposite sides
};

// Quantised heights of the surface, 0 … 65535.
struct HeightRange {
  std::uint16_t lowest, highest;
};

// Writes n² core::TerrainVertex of the surface, row by row, then 4 · (n − 1) of the skirt
// (docs/models.md, "Mesh"). Only writes to `out`, which needs no alignment. 0.5 ns a vertex with
// AVX-512.
HeightRange pack_terrain(const TerrainSurface& surface, std::byte* out);

}  // namespace psygen::models
