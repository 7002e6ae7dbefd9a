// The seam between the parameters of a rock (rock.cpp) and the SIMD kernel that makes its mesh
// (kernel.cpp), which is compiled once per instruction set. Internal to the rock. Pure, any thread.
// docs/models.md, "Rock".
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/mix32.hpp"
#include "engine/models/rock/topology.hpp"

namespace psygen::models {

// Four random numbers in [−1, 1) of item `index` of the rock with this key.
struct RockRandom {
  float f[4];
  // Computes them by hashing, in constant time.
  RockRandom(std::uint64_t key, std::uint32_t index) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const auto word = static_cast<std::uint32_t>(key >> (32 * (i / 2)));
      const std::uint32_t half = mix32(word + kStep * index) >> (16 * (i % 2)) & 0xFFFFU;
      f[i] = static_cast<float>(static_cast<std::int32_t>(half)) * (1.0F / 32768.0F) - 1.0F;
    }
  }
  static constexpr std::uint32_t kStep = 0x9E3779B9U;
};

// The numbers of one rock (docs/models.md, "Rock"). Vertex v uses the random numbers of item 2 + v.
struct RockShape {
  std::uint64_t key;
  float turn[4];           // quaternion x, y, z, w of any length
  float amplitude, decay;  // displacement over the radius; ratio from one subdivision to the next
  glm::vec3 stretch;       // metres of a unit along each axis
  float lift;              // metres from the base point up to the centre
  float rise;              // increase of light and colour per metre of height
  glm::vec3 colour;        // square root of the albedo, times 255
  float moss;              // largest cover, 0 … 1
  float facet;             // weight of the triangle's normal at its corners; 0: shared vertices
  float ledge, tint;       // of layers: distance by which they stand out, difference of their
                           // colour
  glm::vec3 layer_axis;    // across the layers, times their number per unit
  float layer_phase;       // −1 … 1
  glm::vec3 box_centre, box_scale;  // metres to snorm16; the box is larger than the rock
};
inline constexpr float kRockJitter = 0.15F;  // of the tetrahedron's corners; below 1 / (3·√3)
inline constexpr float kRiseAtFoot = 0.16F;  // light and colour at height 0

// Vertices of the mesh: one per position, or three per triangle of a faceted rock.
constexpr std::uint32_t rock_mesh_vertices(int subdivisions, bool faceted) {
  return faceted ? rock_triangles(subdivisions) * 3 : rock_vertices(subdivisions);
}

// Writes rock_mesh_vertices() of core::ModelVertex to `out`, which is not read, and returns their
// bounds in metres. 0 <= subdivisions <= kMaxSubdivisions; time is linear in the vertices.
core::Bounds mesh_rock(const RockShape& shape, const RockTopology& topology, int subdivisions,
                       std::byte* out);

}  // namespace psygen::models
