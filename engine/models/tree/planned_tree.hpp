// The base of all trees as model types: one plan per set of parameters, from which bounds, sizes,
// errors and meshes follow. Derived types make the plan and predict its cost (tree.cpp,
// species_type.cpp). Immutable, any thread. Has no parameters of its own.
#pragma once

#include "engine/core/assert.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/plan.hpp"
#include "engine/models/tree/trunk.hpp"

namespace psygen::models {

// A model type that is a tree.
class PlannedTree : public ModelType {
 public:
  // The plan of one tree. Requires legal parameters. The plan may point into this type.
  virtual TreePlan plan(const Parameters& p) const = 0;

  // ModelType, from the plan.
  int level_count() const final { return kTreeLevels; }
  bool may_run_on_main_thread() const final { return true; }
  double level_error_m(const Parameters& p, int level) const final {
    const TreePlan tree = plan(p);
    return kLevelErrors[level] * static_cast<double>(2 * tree.envelope_across + tree.envelope_up) /
           3;
  }
  core::Bounds bounds(const Parameters& p) const final { return plan(p).bounds; }
  MeshSize mesh_size(const Parameters& p, int level) const final {
    return tree_mesh_size(plan(p), level);
  }
  double steps(const Parameters& p, int level) const final { return tree_steps(plan(p), level); }
  double step_seconds() const final { return 18e-9; }
  core::SurfaceKind surface() const final { return core::SurfaceKind::kBark; }
  Collider collider(const Parameters& p) const final { return trunk_collider(plan(p)); }
  core::Bounds synthesise(const Parameters& p, int level, const MeshView& out) const final {
    return synthesise_tree(plan(p), level, out);
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const final {
    PSYGEN_CHECK(false, "trees share no indices");
  }
};

}  // namespace psygen::models
