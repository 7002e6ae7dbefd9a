// All triangles of a glTF model as one list in the world's metres: node transforms are applied,
// materials and textures become vertex colours. Plain values; pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::handmade {

// Limits: vertices of all nodes together; twice as many triangles are allowed.
inline constexpr std::size_t kMaxVertices = 1U << 20;

// The limits for model files that a world file names.
gltf::Limits gltf_limits();

// A corner of triangles.
struct Vertex {
  glm::vec3 position{0.0F};              // metres from the base point
  glm::vec3 normal{0.0F, 1.0F, 0.0F};    // unit length
  std::array<std::uint8_t, 3> colour{};  // square root of the linear albedo (core::ModelVertex)
  std::uint8_t leaf = 0;                 // 1: its material leaves out pixels, as leaves do
};

struct Triangles {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three for each triangle, counter-clockwise from outside
  core::Bounds box;                    // bounds of the vertices
};

// The model scaled by `how`, with its base point below its centre. Fails with kParse if it is
// smaller than 1 cm or larger than 1 km, and with kOverBudget beyond kMaxVertices. Messages do not
// name the file.
core::Result<Triangles> triangles_of(const gltf::Model& model, const world::HandmadeModel& how);

}  // namespace psygen::handmade
