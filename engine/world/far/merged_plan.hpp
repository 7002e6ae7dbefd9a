// Plans the merged mesh of a node level and level of detail: the form of each scatter, the number
// of models per form, and from these the size of the mesh. Depends only on counts and sizes, not on
// the positions of models. Models placed by hand, whose types need not be scattered in the world,
// are planned one by one. Pure functions, any thread, linear in the scatters.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/models/edits.hpp"
#include "engine/world/far/scatter.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::world {

// One scatter in a node's mesh.
struct ScatterPlan {
  Form form = Form::kTent;
  std::uint32_t together = 1;                 // instances per form
  std::uint64_t groups = 0;                   // groups of so many instances in the node
  std::uint64_t forms = 0;                    // most forms in the node; 0: left out
  bool each_is_synthesised = false;           // false: forms are made from representatives
  const FarScatter::OwnMesh* mesh = nullptr;  // each shows this mesh of its own; null: the form

  std::uint32_t vertices() const {
    return mesh != nullptr ? mesh->vertices : size_of(form).vertices;
  }
  std::uint32_t triangles() const {
    return mesh != nullptr ? mesh->triangles : size_of(form).triangles;
  }
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

// About how often its instances ask for the ground of one tile (NodeWalk).
std::size_t questions_per_tile(const World& world, const LevelPlan& plan);

// Relative time for making the mesh. The unit is close to a nanosecond; use only ratios.
double work_of(const World& world, std::span<const FarScatter> scatters, const LevelPlan& plan);

// The form of one placed model of a node.
struct PlacedForm {
  const models::PlacedModel* model;
  const models::ModelType* type;
  glm::dvec2 in_node_m;     // of its base point
  float size_m;             // upper bound of its height and width
  int mesh_level = kProxy;  // the level of its own mesh that it shows
  std::uint64_t vertices = 0, triangles = 0;

  static constexpr int kProxy = -1;  // a proxy shape instead
};

using TypesByName = std::unordered_map<std::string_view, const models::ModelType*>;

// The forms of the placed models of a node. Models smaller than the error allowed are left out. The
// others show the coarsest level of their own mesh within that error, coarser ones if the mesh
// would be too large, and trees proxies. If there are more than kMaxForms, the largest half has
// forms of its own, and the others share proxies. Linear in the models that are not left out.
struct PlacedPlan {
  static constexpr std::size_t kMaxForms = 2048;

  std::uint64_t together = 1;  // models that a shared proxy stands for
  std::vector<PlacedForm> forms;
  std::size_t shared_from = 0;  // index of the first shared form
  std::uint64_t vertices = 0, triangles = 0;

  // The placed models of `layers` (null: none) on a node of `world`, in addition to a mesh of
  // `beside` vertices. `types`: those that are seen from far.
  PlacedPlan(const World& world, const TypesByName& types,
             std::span<const models::EditLayer* const> layers, const models::QuadCoord& node,
             int form_level, std::uint64_t beside);
  double work() const;
};

// The error in metres that forms of this node level may have: about a pixel where such nodes begin.
double form_error_m(const World& world, int form_level);

// Makes a proxy in `out`. Returns nothing for a model without triangles or one whose type throws.
// `turn` is a unit vector. `mesh` is scratch memory.
std::optional<Form> make_placed_proxy(const PlacedForm& placed, int form_level,
                                      std::uint64_t together, SampleMesh& mesh, glm::vec2 turn,
                                      ProxyMesh& out);

// Upper bound of the height and width of models that extend this far (PlacedModel::reach_m).
float extent_m(const glm::vec3& reach_m);

// Bounds for base points in `box` with models that extend this far from them: sideways, up, down.
core::Bounds with_reach(const core::Bounds& box, const glm::vec3& reach_m);

}  // namespace psygen::world
