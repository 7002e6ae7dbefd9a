// Model types whose synthesis leaves its result elsewhere, as in a cache or a texture. Modelers
// make them in the order of the plan, as meshes; the mesh itself is a triangle without area.
#pragma once

#include <algorithm>
#include <string_view>

#include "engine/models/model_type.hpp"

namespace psygen::models {

// Base of such types. perform() runs in any thread, and does nothing more if its result exists.
class TaskType : public ModelType {
 public:
  int level_count() const final { return 1; }
  double level_error_m(const Parameters&, int) const final { return 0; }
  core::Bounds bounds(const Parameters&) const final { return {glm::vec3(0), glm::vec3(1)}; }
  MeshSize mesh_size(const Parameters&, int) const final {
    return {3, 3, 0, core::VertexLayout::kModel};
  }
  double complexity(const Parameters&, int) const final { return 1; }
  double steps(const Parameters&, int) const override { return 1; }
  double log2_cost(const Parameters&) const final { return 0; }
  bool is_seen_from_far() const final { return false; }
  core::Bounds synthesise(const Parameters& p, int, const MeshView& out) const final {
    perform(p);
    std::ranges::fill(out.vertices, std::byte{0});
    std::ranges::fill(out.indices, std::uint16_t{0});
    return {glm::vec3(0.5F), glm::vec3(0.5F)};
  }

 private:
  virtual void perform(const Parameters& p) const = 0;
};

}  // namespace psygen::models
