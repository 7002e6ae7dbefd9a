// All triangles of a glTF model as one list in the world's metres: nodes are placed, materials and
// textures are the colours of vertices. Plain values; pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/gltf/model.hpp"
#include "engine/world/world.hpp"

namespace psygen::handmade {

// The largest models: of all nodes together, and twice as many triangles.
inline constexpr std::size_t kMaxVertices = 1U << 20;

// A corner of triangles.
struct Vertex {
  glm::vec3 position{0.0F};              // metres from the foot
  glm::vec3 normal{0.0F, 1.0F, 0.0F};    // unit
  std::array<std::uint8_t, 3> colour{};  // square root of the linear albedo (core::ModelVertex)
  std::uint8_t leaf = 0;                 // 1: of a material that leaves out pixels, such as leaves
};

struct Triangles {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // three for each triangle, counter-clockwise from outside
  core::Bounds box;                    // of the vertices
};

// The model as `how` says, with its foot in the middle below it. Fails with kParse where it is too
// small or too large for a model: less than 1 cm or more than 1 km; with kOverBudget beyond
// kMaxVertices. Messages do not name the file.
core::Result<Triangles> triangles_of(const gltf::Model& model, const world::HandmadeModel& how);

}  // namespace psygen::handmade
