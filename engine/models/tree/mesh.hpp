// From a tree's skeleton to packed vertices: the plan of each level of detail, the crown that all
// levels share, bark (bark.cpp), sprays of leaves (sprays.cpp) and hulls (hull.cpp). Everything is
// appended to one MeshWriter, into memory of exactly the size that the plan predicts. Functions are
// pure apart from their output, for any thread. Grows nothing (skeleton.hpp). docs/models.md,
// "Tree".
#pragma once

#include <cmath>
#include <cstring>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {

inline constexpr int kTreeLevels = 6;
// Time of each level over that of level 0, and its error over the crown's radius.
inline constexpr double kLevelShares[kTreeLevels] = {1.0, 0.25, 0.06, 0.02, 0.01, 0.01};
inline constexpr double kLevelErrors[kTreeLevels] = {0.0, 0.05, 0.085, 0.17, 0.33, 0.6};
// Paths whose ends define the crown's position and extent, and carry the foliage of level 3.
inline constexpr std::uint32_t kCrownPaths = 16;

// Appends to a destination, which may be mapped device memory and is never read. The caller ensures
// that it is large enough. Positions are packed = (position − centre) · scale, clamped to ±32767
// and rounded to nearest.
class MeshWriter {
 public:
  // Positions are relative to `box`. The memory of `out` must outlive the writer.
  MeshWriter(const core::Bounds& box, const MeshView& out);

  // A vertex without its position: fields of core::ModelVertex. The normal may have any length
  // except zero.
  struct Look {
    std::uint8_t ambient, sway;
    glm::vec3 normal;
    std::array<std::uint8_t, 3> colour;
    std::uint8_t material;
  };
  // Appends one vertex (position in metres), and one triangle of vertex numbers below 65,536.
  void vertex(const glm::vec3& position, const Look& look);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // Reserve room that kernels fill. Kernels widen `low` and `high` themselves.
  std::byte* append_vertices(std::uint32_t count) {
    std::byte* first = vertices_ + std::size_t{vertex_count_} * sizeof(core::ModelVertex);
    vertex_count_ += count;
    return first;
  }
  std::uint16_t* append_indices(std::uint32_t count) {
    std::uint16_t* first = indices_ + index_count_;
    index_count_ += count;
    return first;
  }
  // Numbers of vertices and indices appended so far.
  std::uint32_t vertex_count() const { return vertex_count_; }
  std::uint32_t index_count() const { return index_count_; }
  // Bounds of all vertices written, in metres, as a reader will unpack them.
  core::Bounds written() const;

  // The packing of positions, and the smallest and largest packed positions so far.
  float centre[3], scale[3];
  std::int16_t low[3] = {32767, 32767, 32767}, high[3] = {-32767, -32767, -32767};

 private:
  glm::vec3 half_;
  std::byte* vertices_;
  std::uint16_t* indices_;
  std::uint32_t vertex_count_ = 0, index_count_ = 0;
};

// The ellipsoid around the ends of kCrownPaths paths. Hulls, ambient light and the normals of
// leaves follow it.
struct TreeCrown {
  glm::vec3 centre;  // metres from the tree's base point
  glm::vec3 half;    // half axes in metres; x and z are equal
  glm::vec3 inverse_half;
  float radius;  // mean of the half axes
};
// The crown, with the same bits from the whole tree (`whole`) or from a skeleton grown with
// kCrownPaths.
TreeCrown crown_of(const TreePlan& plan, const TreeSkeleton& skeleton, bool whole);
// Baked ambient visibility at `p`, in metres from the base point; in (0, 1].
float crown_ambient(const TreeCrown& crown, const glm::vec3& p);

// The outline of a crown about its vertical axis, from the same ends with a margin for leaves.
// Metres.
struct CrownOutline {
  float middle, half_height;  // height of the middle between top and bottom; half their distance
  float upper, lower;         // radius in the upper and in the lower half
};
// The outline. `paths` is a skeleton grown with kCrownPaths.
CrownOutline outline_of(const TreePlan& plan, const TreeSkeleton& paths, const TreeCrown& crown);

// Sides and segments of the tube of a branch. 0 sides: not drawn.
struct TubePlan {
  std::uint32_t sides = 0, segments = 0;
  bool pointed = false;  // ends in one vertex instead of a ring
  // Sizes of one tube.
  constexpr std::uint32_t vertices() const {
    return sides == 0 ? 0 : sides * segments + (pointed ? 1 : sides);
  }
  constexpr std::uint32_t triangles() const { return sides * 2 * segments - (pointed ? sides : 0); }
};
inline constexpr std::uint32_t kMaxSides = 8, kMaxSegments = 6;
// Returns the tube of branches at a depth; `tip`: nothing grows from them. The reference is to
// static data.
const TubePlan& tube_plan(const TreePlan& plan, int level, int depth, bool tip);

// Number of paths that a level follows (kWholeTree: all), and the depth of the last branches that
// it draws.
std::uint32_t paths_of(const TreePlan& plan, int level);
int last_bark_depth(const TreePlan& plan, int level);

// The shape of the sprays of a level, for plans with foliage.
const SprayForm& spray_form(const TreePlan& plan, int level);
// Number of sprays of a level: a multiple of kSprayBlock, 0 at levels 4 and 5 and without foliage.
// It grows with the number of bearers, as far as `bark_vertices` leave room.
std::uint32_t spray_count(const TreePlan& plan, int level, std::uint32_t bearers,
                          std::uint32_t bark_vertices);
inline constexpr std::uint32_t kSprayBlock = 16;
// The crown as one closed, bumpy hull: a ball at level 4, an octahedron at level 5.
inline constexpr std::uint32_t kBallVertices = 12, kBallTriangles = 20;
inline constexpr std::uint32_t kOctahedronVertices = 6, kOctahedronTriangles = 8;
// A cone into the crown, in place of branches that a level omits: from the trunk's end at levels 2
// and 3, from the base at levels 4 and 5.
inline constexpr std::uint32_t kConeVertices = 4, kConeTriangles = 3;

// The stored colour of leaves (square root of the albedo), from TreePlan::ramp. A hue outside [0,
// 1] wraps around for cyclic ramps and is clamped for others.
std::array<float, 3> leaf_colour(const TreePlan& plan, float hue);
// Mean hue and brightness of one tree; its leaves vary around them.
struct LeafTint {
  float hue, brightness;
};
// The tint of the tree with the plan's key.
LeafTint leaf_tint(const TreePlan& plan);

// The indices of sixteen tubes: 16 · 3 · tube.triangles(), aligned to 64 bytes. `tube` must be one
// of tube_plan(). With `in_block`, vertex v of tube i has the number 16 v + 4 (i mod 4) + ⌊i / 4⌋;
// otherwise the tubes follow each other.
const std::uint16_t* tube_pattern(const TubePlan& tube, bool in_block);
// The indices of sixteen sprays in a block, with the same order of vertices. `form` must be one of
// the objects in spray_forms.hpp.
const std::uint16_t* spray_pattern(const SprayForm& form);
// Appends `total` indices: `pattern`, of `length` indices, repeated with `first` added, then
// `first` + `step` and so on.
void append_pattern(const std::uint16_t* pattern, std::size_t length, std::uint32_t first,
                    std::uint32_t step, std::size_t total, MeshWriter& out);

// The parts of a mesh, each appended to `out`: the tubes of all drawn branches, the cone from the
// trunk's end, the cone from the base, `sprays` sprays of leaves, and the hull.
void mesh_bark(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out);
void mesh_core(const TreePlan& plan, const TreeSkeleton& skeleton, const TreeCrown& crown,
               MeshWriter& out);
void mesh_far_trunk(const TreePlan& plan, const TreeCrown& crown, MeshWriter& out);
void mesh_sprays(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out);
void mesh_hull(const TreePlan& plan, int level, const TreeCrown& crown, const CrownOutline& outline,
               MeshWriter& out);

// ModelType::synthesise(), mesh_size() and steps() of every tree. A step is about the time of one
// branch; steps count the branches that are grown and a fixed cost of each group.
core::Bounds synthesise_tree(const TreePlan& plan, int level, const MeshView& out);
MeshSize tree_mesh_size(const TreePlan& plan, int level);
double tree_steps(const TreePlan& plan, int level);

// Capsules from the trunk's sunk base to its end, along its bends; each has the trunk's width at
// its middle. The drawn trunk differs from them by at most 0.1 of its length, its radius and the
// widening at its base together (mesh_test.cpp measures it). Branches have no collider. Constant
// time.
Collider trunk_collider(const TreePlan& plan);

// Metres by which the trunk extends below the base point, to meet sloping ground.
inline float sink_m(const TreePlan& plan) {
  return 2.0F * plan.radius_m;
}

// A model type that is a tree: one plan per set of parameters, from which bounds, sizes, errors and
// meshes follow. Derived types make the plan and predict its cost (tree.cpp, species_type.cpp).
// Immutable, any thread. Has no parameters of its own.
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
};

}  // namespace psygen::models
