#include "engine/models/tree/mesh.hpp"

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/kit/scratch.hpp"
#include "engine/models/tree/paths.hpp"

namespace psygen::models {
namespace {

void mesh_tree(const TreePlan& plan, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out) {
  mesh_bark(plan, level, skeleton, crown, out);
  if (plan.foliage.near == nullptr) return;
  if (level >= 2) mesh_core(plan, skeleton, crown, out);
  const bool by_leaves = has_bearers(plan, skeleton);
  std::uint32_t bearers = 0;
  for (std::size_t g = 0; g < skeleton.group_count; ++g) {
    const TreeGroup& group = skeleton.groups[g];
    if (by_leaves ? bears_leaves(plan, group) : group.tip) bearers += group.count;
  }
  mesh_sprays(plan, level, skeleton, crown, spray_count(plan, level, bearers, out.vertex_count()),
              out);
}

}  // namespace

MeshWriter::MeshWriter(const core::Bounds& box, const MeshView& out)
    : half_(box.half_extent()), vertices_(out.vertices.data()), indices_(out.indices.data()) {
  const glm::vec3 middle = box.centre();
  for (int c = 0; c < 3; ++c) {
    centre[c] = middle[c];
    scale[c] = 32767.0F / half_[c];
  }
}

void MeshWriter::vertex(const glm::vec3& position, const Look& look) {
  core::ModelVertex v;
  for (int c = 0; c < 3; ++c) {
    const float packed = (position[c] - centre[c]) * scale[c];
    const auto q =
        static_cast<std::int16_t>(round_to_int(std::min(std::max(packed, -32767.0F), 32767.0F)));
    v.position[c] = q;
    low[c] = std::min(low[c], q);
    high[c] = std::max(high[c], q);
  }
  const glm::vec2 normal = encode_octahedral(look.normal);
  v.ambient = look.ambient;
  v.sway = look.sway;
  v.normal[0] = pack_snorm16(normal.x);
  v.normal[1] = pack_snorm16(normal.y);
  std::memcpy(v.colour, look.colour.data(), sizeof v.colour);
  v.material = look.material;
  std::memcpy(append_vertices(1), &v, sizeof v);
}

void MeshWriter::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint16_t* to = append_indices(3);
  to[0] = static_cast<std::uint16_t>(a);
  to[1] = static_cast<std::uint16_t>(b);
  to[2] = static_cast<std::uint16_t>(c);
}

core::Bounds MeshWriter::written() const {
  const glm::vec3 middle{centre[0], centre[1], centre[2]};
  const glm::vec3 least{low[0], low[1], low[2]}, most{high[0], high[1], high[2]};
  return {middle + half_ * least / 32767.0F, middle + half_ * most / 32767.0F};
}

std::uint32_t paths_of(const TreePlan& plan, int level) {
  static constexpr std::uint32_t kLeafy[kTreeLevels] = {kWholeTree, kWholeTree, 64, 16, 16, 16};
  static constexpr std::uint32_t kBare[kTreeLevels] = {kWholeTree, kWholeTree, 64, 16, 5, 2};
  return plan.foliage.near != nullptr ? kLeafy[level] : kBare[level];
}

int last_bark_depth(const TreePlan& plan, int level) {
  if (plan.foliage.near == nullptr) return kMaxTreeIterations;
  return level == 2 ? 1 : level >= 3 ? 0 : kMaxTreeIterations;
}

MeshSize tree_mesh_size(const TreePlan& plan, int level) {
  std::uint32_t vertices = 0, triangles = 0;
  const bool leafy = plan.foliage.near != nullptr;
  if (leafy && level >= 4) {
    vertices = kConeVertices + (level == 4 ? kBallVertices : kOctahedronVertices);
    triangles = kConeTriangles + (level == 4 ? kBallTriangles : kOctahedronTriangles);
  } else {
    const bool whole = paths_of(plan, level) == kWholeTree;
    const int depth = whole || plan.always_complete ? plan.iterations : tree_depth(plan);
    const TreeCount count =
        count_tree(plan, depth, paths_of(plan, level), last_bark_depth(plan, level));
    for (std::size_t g = 0; g < count.group_count; ++g) {
      const TreeGroup& group = count.groups[g];
      const TubePlan& tube = tube_plan(plan, level, group.depth, group.tip);
      vertices += group.count * tube.vertices();
      triangles += group.count * tube.triangles();
    }
    if (leafy && level >= 2) {
      vertices += kConeVertices;
      triangles += kConeTriangles;
    }
    const std::uint32_t sprays =
        spray_count(plan, level, count.bearers > 0 ? count.bearers : count.tips, vertices);
    if (sprays > 0) {
      vertices += sprays * spray_form(plan, level).vertices;
      triangles += sprays * spray_form(plan, level).triangles;
    }
  }
  return {vertices, triangles * 3, 0, core::VertexLayout::kModel};
}

double tree_steps(const TreePlan& plan, int level) {
  // In branches: the fixed cost of a group, and of hashing a branch to find the tree's depth.
  constexpr double kPerGroup = 12, kPerCounted = 0.06;
  const auto grown = [](const TreeCount& count) {
    return count.nodes + kPerGroup * static_cast<double>(count.group_count);
  };
  const std::uint32_t paths = paths_of(plan, level);
  if (paths == kWholeTree) return grown(count_tree(plan, plan.iterations));
  int depth = plan.iterations;
  double steps = 0;
  if (!plan.always_complete) {
    const TreeCount whole = count_tree(plan, plan.iterations);
    depth = whole.depth;
    steps = kPerCounted * whole.nodes;
  }
  steps += grown(count_tree(plan, depth, kCrownPaths));
  const bool is_hull = plan.foliage.near != nullptr && level >= 4;
  if (!is_hull && paths != kCrownPaths) steps += grown(count_tree(plan, depth, paths));
  return steps;
}

core::Bounds synthesise_tree(const TreePlan& plan, int level, const MeshView& out) {
  const core::RoundToNearest rounding;
  MeshWriter writer(plan.bounds, out);
  const bool leafy = plan.foliage.near != nullptr;
  const bool whole = paths_of(plan, level) == kWholeTree;
  const int depth = whole || plan.always_complete ? plan.iterations : tree_depth(plan);
  const Scratch<TreeSkeleton> scratch;
  TreeSkeleton& skeleton = *scratch;
  grow_tree(plan, depth, whole ? kWholeTree : kCrownPaths, skeleton);
  const TreeCrown crown = crown_of(plan, skeleton, whole);
  if (leafy && level >= 4) {
    mesh_far_trunk(plan, crown, writer);
    mesh_hull(plan, level, crown, outline_of(plan, skeleton, crown), writer);
  } else {
    if (!whole && paths_of(plan, level) != kCrownPaths)
      grow_tree(plan, depth, paths_of(plan, level), skeleton);
    mesh_tree(plan, level, skeleton, crown, writer);
  }
  PSYGEN_ASSERT(writer.index_count() == out.indices.size() &&
                    writer.vertex_count() * sizeof(core::ModelVertex) == out.vertices.size(),
                "the spans have the sizes of mesh_size()");
  return writer.written();
}

Collider trunk_collider(const TreePlan& plan) {
  const core::RoundToNearest rounding;
  constexpr std::array kEnds{0.0F, 0.15F, 0.5F, 1.0F};
  const Scratch<TreeSkeleton> scratch;
  TreeSkeleton& trunk = *scratch;
  grow_tree(plan, 0, 1, trunk);
  const float end = plan.grammar->grows(plan.axiom) ? plan.taper : 0.0F;
  Collider collider;
  for (std::size_t i = 0; i + 1 < kEnds.size(); ++i) {
    const float middle = 0.5F * (kEnds[i] + kEnds[i + 1]);
    // As places_of_rings() in bark.cpp.
    const float near_foot = std::max(1.0F - 3.0F * middle, 0.0F);
    const float radius = trunk.rows[kRadius][0] * (1.0F - middle * (1.0F - end)) *
                         (1.0F + plan.flare * near_foot * near_foot);
    glm::vec3 from = trunk.point(0, kEnds[i]);
    if (i == 0) from.y -= sink_m(plan);
    collider.shapes.emplace_back(Collider::Capsule{from, trunk.point(0, kEnds[i + 1]), radius});
  }
  return collider;
}

}  // namespace psygen::models
