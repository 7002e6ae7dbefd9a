// Writes forms into the mesh of a node, and fills the rest of the mesh with degenerate triangles.
// One writer per mesh, one thread. It chooses neither forms nor positions (merged_models.cpp).
#pragma once

#include <array>

#include "engine/models/kit/packing.hpp"
#include "engine/world/far/proxy_shapes.hpp"

namespace psygen::world {

// Appends forms to one mesh of core::ModelVertex.
class ProxyWriter {
 public:
  // Positions are packed in `box`. Points outside are moved onto it, and billboards that reach
  // outside are made narrower. `out` must have room for all forms and outlive the writer.
  ProxyWriter(const core::Bounds& box, const models::MeshView& out)
      : box_(box), packer_(box), out_(out) {}

  // Appends a form. `foot` is the base point of the model in the frame of the box, in metres.
  // Without `sways` the sway of all vertices is 0.
  void add(Form form, const ProxyMesh& mesh, const glm::vec3& foot, bool sways);
  // Appends a model's own mesh of core::ModelVertex, packed in `own`.
  void add(std::span<const std::byte> vertices, std::span<const std::uint16_t> indices,
           const core::Bounds& own, const glm::vec3& foot, bool sways);
  // Fills the rest of the mesh and returns the bounds of the added forms, in metres; without any
  // form the centre of the whole box. Call it once, last.
  core::Bounds finish();

 private:
  glm::vec2 limited(glm::vec2 aside, const glm::vec3& axis) const;
  void write(const Corner& c, const glm::vec3& foot, const glm::vec2* aside, bool sways);
  void write(const glm::vec3& place, core::ModelVertex v);

  core::Bounds box_;
  models::BoxPacker packer_;
  models::MeshView out_;
  std::size_t vertices_ = 0, indices_ = 0;
  std::array<std::int16_t, 3> low_{32767, 32767, 32767}, high_{-32767, -32767, -32767};
  float reach_m_ = 0;  // largest distance of a billboard's corner from its position
};

}  // namespace psygen::world
