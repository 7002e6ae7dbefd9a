// Plans the merged mesh of a node level and level of detail: the form of each scatter, the number
// of models per form, and from these the size of the mesh. Depends only on counts and sizes, not on
// the positions of models. Models placed by hand have forms of their own, made from their coarsest
// meshes, because their types need not be scattered in the world. Pure functions, any thread,
// linear in the scatters.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/world/far/scatter.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::world {

// One scatter in a node's mesh.
struct ScatterPlan {
  Form form = Form::kTent;
  std::uint32_t together = 1;        // instances per form
  std::uint64_t forms = 0;           // number of forms in the node; 0: left out
  bool each_is_synthesised = false;  // false: forms are made from representatives
};

// A node's mesh.
struct LevelPlan {
  int level = 1;                              // of the node
  int form_level = 1;                         // node level whose forms are used, >= level
  std::vector<ScatterPlan> scatters;          // in the order of World::scatter
  std::uint64_t vertices = 0, triangles = 0;  // exact size of the mesh
  core::Bounds box;                           // metres from the node's corner
};

// The plan for nodes of `level` with the forms of `form_level`. At most 65,536 vertices: if needed,
// more models share a form. Up to kMaxImpostorLevel, models in `pictures` are impostors.
LevelPlan plan_level(const World& world, std::span<const FarScatter> scatters,
                     const ImpostorSet* pictures, int level, int form_level);

// Relative time for making the mesh. The unit is close to a nanosecond; use only ratios.
double work_of(const World& world, std::span<const FarScatter> scatters, const LevelPlan& plan);

// The number of forms for the placed models of a node. If there are more models, each form stands
// in for several.
struct PlacedPlan {
  static constexpr std::uint64_t kMaxProxies = 1024;

  int form_level = 1;          // node level whose forms are used
  std::uint64_t forms = 0;     // maximum number
  std::uint64_t together = 1;  // models per form

  // For `models` placed models in addition to a mesh of `vertices`.
  PlacedPlan(int level, std::uint64_t models, std::uint64_t vertices);

  // Their part of the mesh, and the time for making them.
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
