// Measures a model for views in which it is a few pixels large: the extreme corners of its mesh,
// its trunk, and its areas from the side and from above. Knows no model type: it measures a mesh.
// Pure functions, any thread, linear in the vertices; the same bits on every machine.
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

// An unpacked vertex: position in metres from the model's base point, unit normal, stored colour
// (square root of the albedo), ambient and sway in [0, 1].
struct Corner {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0, 1, 0};
  glm::vec3 colour{0.0F};
  float ambient = 1, sway = 0;
  std::uint8_t material = 0;
};

// Unpacks a vertex that is packed in `box`. Of its material it keeps only leaf or not.
Corner corner_of(const core::ModelVertex& v, const core::Bounds& box);

// Linear interpolation from `a` (t = 0) to `b` (t = 1). The material is that of `a`; the normal is
// not normalised.
Corner mixed(const Corner& a, const Corner& b, float t);

// The corners furthest up, down and along +x, +z, −x, −z: of the leaves, or of the whole mesh if it
// has none. Exact for a crown that is an octahedron.
struct Outline {
  Corner top, bottom;
  std::array<Corner, 4> ring;
  Corner foot;             // mean of the other vertices, at their lowest height
  float trunk_radius = 0;  // at the foot; 0: no trunk outside of the crown
  bool leafy = false;      // the mesh has leaves

  glm::vec2 axis() const;     // x and z of the centre of the ring
  float ring_height() const;  // mean y of the ring
  float ring_radius() const;  // mean distance of the ring from the axis
  Corner mean_ring() const;   // mean of the ring, with the normal upwards
  // The outline of the model made `across` times as wide and `up` times as high.
  Outline scaled(float across, float up) const;
};

// The outline of core::ModelVertex whose positions are packed in `box`. Nothing if there are no
// vertices.
std::optional<Outline> outline_of(std::span<const std::byte> vertices, const core::Bounds& box);

// Areas of a mesh in m²: from the side (mean of four directions, only above y = 0), and from above.
// Overlapping triangles count once. Accurate to about 3 %.
struct Silhouette {
  float side_m2 = 0, plan_m2 = 0;

  // The areas of the model made `across` times as wide and `up` times as high.
  Silhouette scaled(float across, float up) const {
    return {side_m2 * across * up, plan_m2 * across * across};
  }
};
// The silhouette of triangles over `places`, in metres.
Silhouette silhouette_of(std::span<const glm::vec3> places, std::span<const std::uint16_t> indices);

// A synthesised mesh of one model, for measuring. Reuses its memory for the next model.
class SampleMesh {
 public:
  // Synthesises a level of the mesh, by default the coarsest. User types may throw. The layout must
  // be core::VertexLayout::kModel.
  void make(const models::ModelType& type, const models::Parameters& p, int level);
  void make(const models::ModelType& type, const models::Parameters& p) {
    make(type, p, type.level_count() - 1);
  }
  // The mesh, its bounds and its outline. The span is valid until the next make().
  std::span<const std::byte> vertices() const { return vertices_; }
  const core::Bounds& box() const { return box_; }
  std::optional<Outline> outline() const { return outline_of(vertices_, box_); }
  // Its triangles and its silhouette. `type` must be that of make(), because its shared indices may
  // be needed.
  std::vector<std::uint16_t> indices(const models::ModelType& type) const;
  Silhouette silhouette(const models::ModelType& type) const;

 private:
  models::MeshSize size_;
  core::Bounds box_;
  std::vector<std::byte> vertices_;
  std::vector<std::uint16_t> indices_;
};

}  // namespace psygen::world
