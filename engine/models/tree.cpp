#include "engine/models/tree.hpp"

#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/models/tree_mesh.hpp"

namespace psygen::models {
namespace {

using enum ParameterType;
constexpr ParameterSpec kSchema[kTreeParameterCount] = {
    {"seed", kInteger, "", 1, -9.3e18, 9.3e18, 0, 1e6, "which tree of its kind this is",
     ParameterSource::kPlaced},
    {"iterations", kInteger, "1", 4, 1, kMaxTreeIterations, 2, 5,
     "times that every branch end branches again"},
    {"branches", kInteger, "1", 3, 1, 6, 2, 4,
     "branches of each node on average: each draws from two less to two more, at least 1"},
    {"size_m", kReal, "m", 2.4, 0.1, 30, 1, 6, "length of the trunk up to its end"},
    {"radius_m", kReal, "m", 0.17, 0.005, 3, 0.05, 0.6, "radius of the trunk above its flare"},
    {"branch_angle", kReal, "rad", 0.8, 0, 2.5, 0.3, 1.3,
     "between a branch and the one that it grows from"},
    {"angle_variation", kReal, "1", 0.35, 0, 1, 0, 0.8, "spread of the angles"},
    {"length_decay", kReal, "1", 0.76, 0.3, 1, 0.55, 0.9, "length of a branch over its parent's"},
    {"radius_decay", kReal, "1", 0.62, 0.2, 1, 0.4, 0.8,
     "radius of a side branch over its parent's"},
    {"tropism", kReal, "1", 0.18, -1, 1, -0.3, 0.5, "bends branches up, or down where negative"},
    {"curvature", kReal, "1", 0.4, 0, 1, 0, 0.8, "how crooked branches are"},
    {"flare", kReal, "1", 0.7, 0, 3, 0, 1.5, "widening of the trunk at its foot"},
    {"leaf_scale", kReal, "1", 1, 0.1, 3, 0.5, 1.5,
     "size of leaves over the size that just fills the crown"},
    {"leaf_hue", kReal, "1", 0.14, 0, 1, 0, 1,
     "from deep green (0) over green, yellow and orange to red (1)"},
    {"colour_variation", kReal, "1", 0.5, 0, 1, 0, 1, "spread of colour between leaves and trees"},
    {"bark_tone", kReal, "1", 0.55, 0, 1, 0, 1, "from grey (0) to brown (1)"},
};

// How far branches reach from the trunk's end and from the axis: geometric sums of upper bounds.
struct Reach {
  double trunk, branches;
};
Reach reach_of(const TreeShape& s) {
  const double crooked = 1 + 0.45 * s.curvature + 0.35 * std::abs(s.tropism);
  double length = 1.1 * s.size_m, sum = 0;
  const double trunk = length;
  for (int i = 0; i < s.iterations; ++i) {
    length *= s.length_decay * double{kMaxLengthFactor};
    sum += length * crooked;
  }
  return {trunk, sum};
}

class TreeType final : public ModelType {
 public:
  std::string_view name() const override { return "tree"; }
  std::string_view doc() const override {
    return "a broadleaf tree grown by a stochastic L-system; cost is proportional to "
           "branches^iterations";
  }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  int level_count() const override { return kTreeLevels; }
  bool may_run_on_main_thread() const override { return true; }
  double level_error_m(const Parameters& p, int level) const override;
  core::Bounds bounds(const Parameters& p) const override;
  MeshSize mesh_size(const Parameters& p, int level) const override;
  double complexity(const Parameters& p, int level) const override;
  double log2_cost(const Parameters& p) const override;
  core::Bounds synthesize(const Parameters& p, int level, const MeshView& out) const override;
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {
    PSYGEN_CHECK(false, "trees share no indices");
  }
};

double TreeType::level_error_m(const Parameters& p, int level) const {
  static constexpr double kShare[kTreeLevels] = {0.0, 0.05, 0.085, 0.17, 0.33, 0.6};
  const TreeShape s(p);
  return kShare[level] * (2 * s.envelope_across + s.envelope_up) / 3;
}

core::Bounds TreeType::bounds(const Parameters& p) const {
  const TreeShape s(p);
  const Reach reach = reach_of(s);
  const double foliage = 0.6 * s.size_m + 0.3 * s.envelope_across * s.leaf_scale;
  const double across = std::min(reach.branches, 1.35 * s.envelope_across) + foliage;
  const double foot = s.radius_m * (1.2 + 2.0 * s.flare);
  const double up = std::min(reach.branches, s.envelope_y - s.size_m + 1.35 * s.envelope_up);
  const auto side = static_cast<float>(std::max(0.35 * reach.trunk + across, foot));
  const auto top = static_cast<float>(reach.trunk + up + foliage);
  const float bottom = -1.1F * sink_m(s) - 0.12F * static_cast<float>(foot);
  return {{-side, bottom, -side}, {side, top, side}};
}

MeshSize TreeType::mesh_size(const Parameters& p, int level) const {
  const TreeShape s(p);
  std::uint32_t vertices = 0, triangles = 0, sprays = 0;
  if (level >= 4) {
    vertices = kConeVertices + (level == 4 ? kBallVertices : kOctahedronVertices);
    triangles = kConeTriangles + (level == 4 ? kBallTriangles : kOctahedronTriangles);
  } else if (level >= 2) {  // trunk and, at level 2, its branches
    const TubePlan trunk = tube_plan(level, 0, false);
    const TubePlan branch = tube_plan(level, 1, s.iterations == 1);
    const std::uint32_t children = child_count(s.root_key, s.branches);
    sprays = spray_count(level, 0);
    vertices = trunk.vertices() + children * branch.vertices() + kConeVertices;
    triangles = trunk.triangles() + children * branch.triangles() + kConeTriangles;
  } else {
    const TreeCount count = count_tree(s);
    sprays = spray_count(level, count.tips());
    for (int depth = 0; depth <= count.depth; ++depth) {
      const TubePlan plan = tube_plan(level, depth, depth == count.depth);
      const std::uint32_t nodes = count.nodes[static_cast<std::size_t>(depth)];
      vertices += nodes * plan.vertices();
      triangles += nodes * plan.triangles();
    }
  }
  vertices += sprays * kSprayVertices;
  triangles += sprays * kSprayTriangles;
  return {vertices, triangles * 3, 0, core::VertexLayout::kModel};
}

double TreeType::complexity(const Parameters& p, int level) const {
  static constexpr double kShare[kTreeLevels] = {1.0, 0.25, 0.06, 0.02, 0.01, 0.01};
  return kShare[level] * std::pow(static_cast<double>(p.integer(kTreeBranches)),
                                  static_cast<double>(p.integer(kTreeIterations)));
}

double TreeType::log2_cost(const Parameters& p) const {
  const double n = std::max(0.0, static_cast<double>(p.integer(kTreeIterations)));
  const double m = std::max(1.0, static_cast<double>(p.integer(kTreeBranches)));
  const double grown = std::max(n * std::log2(m + 2.0) + 5.0, 12.0);
  const bool capped = n <= kMaxTreeIterations && m <= kSchema[kTreeBranches].hard_max;
  return capped ? std::min(grown, 15.6) : grown;
}

core::Bounds TreeType::synthesize(const Parameters& p, int level, const MeshView& out) const {
  const TreeShape s(p);
  MeshWriter writer(bounds(p), out);
  const int depth = tip_depth(s);
  TreeSkeleton skeleton;
  grow_tree(s, depth, kCrownPaths, skeleton);
  const TreeCrown crown = crown_of(s, skeleton);
  if (level >= 4) {
    mesh_far_trunk(s, crown, writer);
    mesh_hull(s, level, crown, writer);
  } else {
    if (level < 3) grow_tree(s, depth, level == 2 ? spray_count(2, 0) : kWholeTree, skeleton);
    mesh_bark(s, level, skeleton, crown, writer);
    if (level >= 2) mesh_core(s, skeleton, crown, writer);
    mesh_sprays(s, level, skeleton, crown, spray_count(level, skeleton.tip_count()), writer);
  }
  PSYGEN_ASSERT(writer.index_count() == out.indices.size() &&
                    writer.vertex_count() * sizeof(core::ModelVertex) == out.vertices.size(),
                "the spans have the sizes of mesh_size()");
  return writer.written();
}

}  // namespace

MeshWriter::MeshWriter(const core::Bounds& box, const MeshView& out)
    : center_(box.center()),
      scale_(glm::vec3(32767.0F) / box.half_extent()),
      half_(box.half_extent()),
      vertices_(out.vertices.data()),
      indices_(out.indices.data()) {}

core::Bounds MeshWriter::written() const {
  const glm::vec3 low{low_[0], low_[1], low_[2]}, high{high_[0], high_[1], high_[2]};
  return {center_ + half_ * low / 32767.0F, center_ + half_ * high / 32767.0F};
}

std::unique_ptr<ModelType> make_tree_type() {
  return std::make_unique<TreeType>();
}

}  // namespace psygen::models
