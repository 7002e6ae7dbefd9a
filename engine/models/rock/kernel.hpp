// The seam between the parameters of a rock (rock.cpp) and the SIMD kernel that makes its mesh
// (kernel.cpp), compiled once for every instruction set. Not for other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/mix32.hpp"
#include "engine/models/rock/topology.hpp"

namespace psygen::models {

// Numbers in [−1, 1) that belong to item `index` of the rock of this key.
struct RockRandom {
  float f[4];
  RockRandom(std::uint64_t key, std::uint32_t index) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const auto word = static_cast<std::uint32_t>(key >> (32 * (i / 2)));
      const std::uint32_t half = mix32(word + kStep * index) >> (16 * (i % 2)) & 0xFFFFU;
      f[i] = static_cast<float>(static_cast<std::int32_t>(half)) * (1.0F / 32768.0F) - 1.0F;
    }
  }
  static constexpr std::uint32_t kStep = 0x9E3779B9U;
};

// A rock as docs/models.md, "Rock" has it; the item of vertex v is 2 + v.
struct RockShape {
  std::uint64_t key;
  float turn[4];  // quaternion x, y, z, w of any length
  float amplitude, decay;
  glm::vec3 stretch;  // metres
  float lift;         // metres
  float rise;         // of light and colour, per metre
  glm::vec3 colour;   // albedo as it is stored, its root, times 255
  float moss;
  float facet;           // share of the triangle's own normal in its vertices'; 0: shared vertices
  float ledge, tint;     // of layers: how far they stand out, how much their colour differs
  glm::vec3 layer_axis;  // across the layers, times their number per unit
  float layer_phase;     // 0 … 1
  glm::vec3 box_centre, box_scale;  // to snorm16; the box is larger than the rock
};
inline constexpr float kRockJitter = 0.15F;  // of the tetrahedron's corners; below 1 / (3·√3)
inline constexpr float kRiseAtFoot = 0.16F;

// Vertices of the mesh: one a place, or three a triangle where triangles show.
constexpr std::uint32_t rock_mesh_vertices(int subdivisions, bool faceted) {
  return faceted ? rock_triangles(subdivisions) * 3 : rock_vertices(subdivisions);
}

// Writes so many core::ModelVertex to `out` and returns their box. Needs 700 KiB of stack for 6
// subdivisions, 5 KiB for 2.
core::Bounds mesh_rock(const RockShape& shape, const RockTopology& topology, int subdivisions,
                       std::byte* out);

}  // namespace psygen::models
