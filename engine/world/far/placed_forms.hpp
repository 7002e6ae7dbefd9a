// The forms of models that were placed by hand, in the mesh of a node. Each is made from the
// coarsest mesh of the model itself, because its type need not be scattered in the world. Pure
// functions, any thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/far/forms.hpp"
#include "engine/world/far/outline.hpp"

namespace psygen::world {

// How many forms the placed models of a node get. Where there are more models, each form stands for
// several.
struct PlacedPlan {
  static constexpr std::uint64_t kMaxForms = 1024;

  int form_level = 1;          // node level whose forms are used
  std::uint64_t forms = 0;     // at most
  std::uint64_t together = 1;  // models a form

  // For `models` placed models beside a mesh of `vertices`.
  PlacedPlan(int level, std::uint64_t models, std::uint64_t vertices);

  // Room for them in the mesh, and the time for making them (merged_plan.hpp).
  std::uint64_t vertices() const;
  std::uint64_t triangles() const;
  double work() const { return 3000 * static_cast<double>(forms); }
};

// Makes the form of a placed model in `out`; nothing for a model without triangles, or one whose
// type throws. `turn` is a unit vector. `mesh` is scratch memory.
std::optional<Form> make_placed_form(const models::ModelType& type,
                                     const models::Parameters& parameters, const PlacedPlan& plan,
                                     SampleMesh& mesh, glm::vec2 turn, FormMesh& out);

// A box with room for feet that lie in it and what reaches this far from them: sideways, up, down.
core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m);

}  // namespace psygen::world
