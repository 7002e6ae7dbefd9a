// The seam between the parameters of a rock (rock.cpp) and the SIMD kernel that makes its mesh
// (rock_kernel.cpp), compiled once for every instruction set. Not for other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/rock_topology.hpp"

namespace psygen::models {

// Numbers in [−1, 1) that belong to item `index` of the rock of this key.
struct RockRandom {
  float f[4];
  RockRandom(std::uint64_t key, std::uint64_t index) {
    const std::uint64_t h = core::mix64(key + 0x9E3779B97F4A7C15ull * (index + 1));
    for (int i = 0; i < 4; ++i)
      f[i] = static_cast<float>(static_cast<std::int32_t>((h >> (16 * i)) & 0xFFFFU)) *
                 (1.0F / 32768.0F) -
             1.0F;
  }
};

// A rock as docs/models.md, "Rock" has it; the item of vertex v is 2 + v.
struct RockShape {
  std::uint64_t key;
  float amplitude, decay;
  glm::vec3 stretch;  // metres
  float lift;         // metres
  glm::vec3 colour;   // albedo
  float moss;
  float facet;           // share of the triangle's own normal in its vertices' normals
  float ledge, tint;     // of layers: how far they stand out, how much their albedo differs
  glm::vec3 layer_axis;  // across the layers, times their number per unit
  float layer_phase;     // 0 … 1
  glm::vec3 corners[4];  // of the tetrahedron, unit distance from the centre
  float corner_radius[4];
  glm::vec3 box_centre, box_scale;  // to snorm16
};

// Writes 3 · rock_triangles(subdivisions) core::ModelVertex to `out` and returns their box. About
// 16 cycles a triangle. Needs 800 KiB of stack.
core::Bounds mesh_rock(const RockShape& shape, const RockTopology& topology, int subdivisions,
                       std::byte* out);

}  // namespace psygen::models
