// Meshes of deer, birds and fish, in parts that swing, made of a few ellipsoids and fins. Pure
// functions. Units are metres; the animals face −Z.
#pragma once

#include <array>

#include "engine/core/mesh_data.hpp"
#include "game/play/creatures.hpp"

namespace cairns {

// A creature is a body and up to two parts that swing against each other.
inline constexpr std::size_t kParts = 3;
struct Part {
  core::MeshData mesh;
  glm::vec3 joint{0.0F};  // pivot, relative to the creature's base point
  glm::vec3 axis{1, 0, 0};
  float swing = 0;  // amplitude in radians
};
// Returns the parts of a creature. Unused parts have no triangles.
std::array<Part, kParts> parts_of(Kind kind);

}  // namespace cairns
