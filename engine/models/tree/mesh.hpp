// From a tree's skeleton to packed vertices: the plan of each level of detail, the crown that all
// levels share, bark (bark.cpp), sprays of leaves (sprays.cpp) and hulls (hull.cpp).
// Everything is appended to one MeshWriter, into memory of exactly the size that the plan predicts.
#pragma once

#include <cmath>
#include <cstring>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {

inline constexpr int kTreeLevels = 6;
// Share of level 0 in the time of each level, and of the crown's radius in its error.
inline constexpr double kLevelShares[kTreeLevels] = {1.0, 0.25, 0.06, 0.02, 0.01, 0.01};
inline constexpr double kLevelErrors[kTreeLevels] = {0.0, 0.05, 0.085, 0.17, 0.33, 0.6};
// Paths that give the crown its place and extent, and the foliage of level 3.
inline constexpr std::uint32_t kCrownPaths = 16;

// Appends to the destination, which may be mapped device memory: it is not read. Positions are
// relative to `box`: packed = (position - center) · scale, clamped to ±32767, rounded to nearest.
class MeshWriter {
 public:
  MeshWriter(const core::Bounds& box, const MeshView& out);

  struct Look {
    std::uint8_t ambient, sway;
    glm::vec3 normal;
    std::array<std::uint8_t, 3> colour;
    std::uint8_t material;
  };
  void vertex(const glm::vec3& position, const Look& look);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // Room that kernels fill; they widen `low` and `high` themselves.
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
  std::uint32_t vertex_count() const { return vertex_count_; }
  std::uint32_t index_count() const { return index_count_; }
  // The box of all vertices written, as a reader will unpack them.
  core::Bounds written() const;

  float center[3], scale[3];
  std::int16_t low[3] = {32767, 32767, 32767}, high[3] = {-32767, -32767, -32767};

 private:
  glm::vec3 half_;
  std::byte* vertices_;
  std::uint16_t* indices_;
  std::uint32_t vertex_count_ = 0, index_count_ = 0;
};

// The ellipsoid that the tips of kCrownPaths paths lie in: place of hulls, of ambient light, and of
// the normals of leaves.
struct TreeCrown {
  glm::vec3 center;
  glm::vec3 half;  // half axes in metres; x and z are equal
  glm::vec3 inverse_half;
  float radius;  // their mean
};
// From the whole tree, or from the paths grown with kCrownPaths: the same bits.
TreeCrown crown_of(const TreePlan& plan, const TreeSkeleton& skeleton, bool whole);
float crown_ambient(const TreeCrown& crown, const glm::vec3& p);

// The outline of a crown about its vertical axis: where the same ends lie, and room for leaves.
struct CrownOutline {
  float middle, half_height;  // of top and bottom
  float upper, lower;         // radius in the upper and in the lower half
};
// `paths` are those grown with kCrownPaths.
CrownOutline outline_of(const TreePlan& plan, const TreeSkeleton& paths, const TreeCrown& crown);

// Sides and segments of the tube of a branch at a depth; 0 sides: not drawn. A tip ends in one
// vertex.
struct TubePlan {
  std::uint32_t sides = 0, segments = 0;
  bool pointed = false;
  constexpr std::uint32_t vertices() const {
    return sides == 0 ? 0 : sides * segments + (pointed ? 1 : sides);
  }
  constexpr std::uint32_t triangles() const { return sides * 2 * segments - (pointed ? sides : 0); }
};
inline constexpr std::uint32_t kMaxSides = 8, kMaxSegments = 6;
const TubePlan& tube_plan(const TreePlan& plan, int level, int depth, bool tip);

// Which paths a level follows, and the depth of the last branches that it draws.
std::uint32_t paths_of(const TreePlan& plan, int level);
int last_bark_depth(const TreePlan& plan, int level);

// Sprays of levels 0 … 3, a multiple of 16: for a tree with so many bearers, whose other vertices
// leave room for so many.
const SprayForm& spray_form(const TreePlan& plan, int level);
std::uint32_t spray_count(const TreePlan& plan, int level, std::uint32_t bearers,
                          std::uint32_t bark_vertices);
inline constexpr std::uint32_t kSprayBlock = 16;
// Levels 4 and 5: the crown as one closed, bumpy hull.
inline constexpr std::uint32_t kBallVertices = 12, kBallTriangles = 20;
inline constexpr std::uint32_t kOctahedronVertices = 6, kOctahedronTriangles = 8;
// Cones of 4 vertices and 3 triangles into the crown: from the trunk's end where the branches in
// between are left out (levels 2 and 3), from the foot (levels 4 and 5).
inline constexpr std::uint32_t kConeVertices = 4, kConeTriangles = 3;

// Stored (square root) colour of leaves.
std::array<float, 3> leaf_colour(const TreePlan& plan, float hue);
// Hue and brightness of a whole tree, about which its leaves vary.
struct LeafTint {
  float hue, brightness;
};
LeafTint leaf_tint(const TreePlan& plan);

void mesh_bark(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out);
void mesh_core(const TreePlan& plan, const TreeSkeleton& skeleton, const TreeCrown& crown,
               MeshWriter& out);
void mesh_far_trunk(const TreePlan& plan, const TreeCrown& crown, MeshWriter& out);
void mesh_sprays(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out);
void mesh_hull(const TreePlan& plan, int level, const TreeCrown& crown, const CrownOutline& outline,
               MeshWriter& out);

// All of them: what synthesize() and mesh_size() of every tree do.
core::Bounds synthesize_tree(const TreePlan& plan, int level, const MeshView& out);
MeshSize tree_mesh_size(const TreePlan& plan, int level);
// Branches that are grown for it, and what each group of them takes by itself.
double tree_steps(const TreePlan& plan, int level);

// Metres that the trunk reaches below the foot, so that it meets sloping ground.
inline float sink_m(const TreePlan& plan) {
  return 2.0F * plan.radius_m;
}

}  // namespace psygen::models
