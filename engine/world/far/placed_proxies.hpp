// The forms of models placed by hand, in the mesh of a node. Each is made from the coarsest mesh of
// the model itself, because its type need not be scattered in the world. Pure functions, any
// thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/far/outline.hpp"
#include "engine/world/far/proxy_shapes.hpp"

namespace psygen::world {

// The number of forms for the placed models of a node. If there are more models, each form stands
// in for several.
struct PlacedPlan {
  static constexpr std::uint64_t kMaxProxies = 1024;

  int form_level = 1;          // node level whose forms are used
  std::uint64_t forms = 0;     // maximum number
  std::uint64_t together = 1;  // models per form

  // For `models` placed models in addition to a mesh of `vertices`.
  PlacedPlan(int level, std::uint64_t models, std::uint64_t vertices);

  // Their part of the mesh, and the time for making them (merged_plan.hpp).
  std::uint64_t vertices() const;
  std::uint64_t triangles() const;
  double work() const { return 3000 * static_cast<double>(forms); }
};

// Makes the form of a placed model in `out`. Returns nothing for a model without triangles or one
// whose type throws. `turn` is a unit vector. `mesh` is scratch memory.
std::optional<Form> make_placed_proxy(const models::ModelType& type,
                                      const models::Parameters& parameters, const PlacedPlan& plan,
                                      SampleMesh& mesh, glm::vec2 turn, ProxyMesh& out);

// Bounds for base points in `box` with models that extend this far from them: sideways, up, down.
core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m);

}  // namespace psygen::world
