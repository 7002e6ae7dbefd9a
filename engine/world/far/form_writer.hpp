// Writes far forms into the mesh of a node, and fills what is left over with triangles that cannot
// be seen. For one mesh and one thread.
#pragma once

#include <array>

#include "engine/models/kit/packing.hpp"
#include "engine/world/far/forms.hpp"

namespace psygen::world {

class FormWriter {
 public:
  // Positions are in `box`; what reaches beyond is moved onto it, and billboards are made narrower.
  // `out` has room for all forms.
  FormWriter(const core::Bounds& box, const models::MeshView& out)
      : box_(box), packer_(box), out_(out) {}

  // `foot` is where the model stands, in the frame of the box.
  void add(Form form, const FormMesh& mesh, const glm::vec3& foot, bool sways);
  // The box of what was added; the middle of the whole box if that is nothing.
  core::Bounds finish();

 private:
  glm::vec2 limited(glm::vec2 aside, const glm::vec3& axis) const;
  void write(const Corner& c, const glm::vec3& foot, const glm::vec2* aside, bool sways);

  core::Bounds box_;
  models::BoxPacker packer_;
  models::MeshView out_;
  std::size_t vertices_ = 0, indices_ = 0;
  std::array<std::int16_t, 3> low_{32767, 32767, 32767}, high_{-32767, -32767, -32767};
  float reach_m_ = 0;  // of billboards, beyond their positions
};

}  // namespace psygen::world
