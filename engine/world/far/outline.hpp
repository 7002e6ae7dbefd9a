// What remains of a model that is a few pixels large: the extreme corners of its mesh, its trunk,
// and how much of the picture it covers from the side and of the ground from above. Knows no model
// type: everything is measured on a mesh. Pure functions; the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::world {

inline constexpr std::uint8_t kLeaf = 1;  // core::ModelVertex::material

// A vertex as numbers: metres from the model's foot, unit normal, colour as stored (square root of
// the albedo), ambient and sway in [0, 1].
struct Corner {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0, 1, 0};
  glm::vec3 colour{0.0F};
  float ambient = 1, sway = 0;
  std::uint8_t material = 0;
};

// Everything between two corners, at `t` in [0, 1]; the material is that of `a`.
Corner mixed(const Corner& a, const Corner& b, float t);

// The corners furthest up, down and along +x, +z, −x, −z: of the leaves, or of all of it where
// there are none. A crown that is an octahedron is given back exactly.
struct Outline {
  Corner top, bottom;
  std::array<Corner, 4> ring;
  Corner foot;             // mean of what is not leaf, at its lowest point
  float trunk_radius = 0;  // at the foot; 0: no trunk apart from the crown
  bool leafy = false;

  glm::vec2 axis() const;     // x, z of the middle of the ring
  float ring_height() const;  // mean y of the ring
  float ring_radius() const;  // mean distance from the axis
  Corner mean_ring() const;   // all of it the mean, the normal upwards
  // The same, so many times as wide and as high.
  Outline scaled(float across, float up) const;
};

// Of core::ModelVertex, whose positions are in `box`; nothing for no vertices.
std::optional<Outline> outline_of(std::span<const std::byte> vertices, const core::Bounds& box);

// Areas in m² of what stands above y = 0: seen from the side (the mean of four directions), and
// from above. Overlapping triangles count once. To about 3 %.
struct Silhouette {
  float side_m2 = 0, plan_m2 = 0;

  // Of the same, so many times as wide and as high.
  Silhouette scaled(float across, float up) const {
    return {side_m2 * across * up, plan_m2 * across * across};
  }
};
Silhouette silhouette_of(std::span<const glm::vec3> places, std::span<const std::uint16_t> indices);

// Room for the coarsest mesh of one model after the other.
class CoarsestMesh {
 public:
  // Synthesises it. Types of users may throw; the layout must be core::VertexLayout::kModel.
  void make(const models::ModelType& type, const models::Parameters& p);
  std::span<const std::byte> vertices() const { return vertices_; }
  const core::Bounds& box() const { return box_; }
  std::optional<Outline> outline() const { return outline_of(vertices_, box_); }
  // Reads the shared indices too.
  Silhouette silhouette(const models::ModelType& type) const;

 private:
  models::MeshSize size_;
  core::Bounds box_;
  std::vector<std::byte> vertices_;
  std::vector<std::uint16_t> indices_;
};

}  // namespace psygen::world
