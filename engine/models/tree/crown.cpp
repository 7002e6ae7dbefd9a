// Position, extent and light of a tree's crown, from the ends of the branches on a few paths.
#include <cmath>

#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/paths.hpp"

namespace psygen::models {
namespace {

struct Ends {
  std::array<glm::vec3, kCrownPaths*(kMaxTreeIterations + 1)> at;
  std::uint32_t count = 0;
  Ends() {}
  void add(const glm::vec3& end) { at[count++] = end; }
};

// Finds the ends of the branches that bear leaves, or of the tips if no branch does.
void ends_of_paths(const TreePlan& plan, const TreeSkeleton& paths, Ends& out) {
  const bool by_leaves = has_bearers(plan, paths);
  for (std::size_t g = 0; g < paths.group_count; ++g) {
    const TreeGroup& group = paths.groups[g];
    if (by_leaves ? !bears_leaves(plan, group) : !group.tip) continue;
    for (std::uint32_t i = 0; i < group.count; ++i)
      out.add(paths.point(group.first + i, 1.0F));
  }
}

// Finds the same ends in a whole tree.
void ends_of_tree(const TreePlan& plan, const TreeSkeleton& tree, Ends& out) {
  TreePaths paths;
  find_paths(plan, tree, kCrownPaths, paths);
  const auto is_tip = [&](const TreePaths::Node& node) {
    return node.depth == paths.depth || !plan.grammar->grows(node.kind);
  };
  const auto bears = [&](const TreePaths::Node& node) {
    const LeavesOn leaves = plan.kinds[node.kind].leaves;
    return leaves == LeavesOn::kAll || (leaves == LeavesOn::kTips && is_tip(node));
  };
  bool by_leaves = false;
  for (std::uint32_t i = 0; plan.foliage.near != nullptr && i < paths.count; ++i)
    by_leaves = by_leaves || bears(paths.nodes[i]);
  for (std::uint32_t i = 0; i < paths.count; ++i) {
    const TreePaths::Node& node = paths.nodes[i];
    if (by_leaves ? bears(node) : is_tip(node)) out.add(tree.point(node.slot, 1.0F));
  }
}

}  // namespace

TreeCrown crown_of(const TreePlan& plan, const TreeSkeleton& skeleton, bool whole) {
  Ends ends;
  if (whole)
    ends_of_tree(plan, skeleton, ends);
  else
    ends_of_paths(plan, skeleton, ends);
  glm::vec3 sum(0.0F), squares(0.0F);
  for (std::uint32_t i = 0; i < ends.count; ++i)
    sum += ends.at[i];
  const float inverse = 1.0F / static_cast<float>(std::max(ends.count, 1U));
  const glm::vec3 centre = sum * inverse;
  for (std::uint32_t i = 0; i < ends.count; ++i) {
    const glm::vec3 d = ends.at[i] - centre;
    squares += d * d;
  }
  const float least = 0.3F * plan.size_m;
  const float across = least + 1.5F * std::sqrt((squares.x + squares.z) * 0.5F * inverse);
  const float up = least + 1.5F * std::sqrt(squares.y * inverse);
  const glm::vec3 half{across, up, across};
  return {centre, half, 1.0F / half, (2.0F * across + up) * (1.0F / 3.0F)};
}

CrownOutline outline_of(const TreePlan& plan, const TreeSkeleton& paths, const TreeCrown& crown) {
  Ends ends;
  ends_of_paths(plan, paths, ends);
  float top = ends.at[0].y, bottom = top;
  for (std::uint32_t i = 1; i < ends.count; ++i) {
    top = std::max(top, ends.at[i].y);
    bottom = std::min(bottom, ends.at[i].y);
  }
  const float leaves = 0.2F * crown.half.x;
  const float middle = 0.5F * (top + bottom), half_height = 0.5F * (top - bottom) + leaves;
  float squares[2] = {0.0F, 0.0F}, weights[2] = {0.0F, 0.0F};
  for (std::uint32_t i = 0; i < ends.count; ++i) {
    const glm::vec3 d = ends.at[i] - crown.centre;
    const float up = 0.5F + 0.5F * (ends.at[i].y - middle) / half_height;
    const float squared[2] = {up * up, (1.0F - up) * (1.0F - up)};
    const float weight[2] = {squared[0] * squared[0], squared[1] * squared[1]};
    for (int k = 0; k < 2; ++k) {
      squares[k] += weight[k] * (d.x * d.x + d.z * d.z);
      weights[k] += weight[k];
    }
  }
  return {middle, half_height, leaves + 1.25F * std::sqrt(squares[0] / weights[0]),
          leaves + 1.25F * std::sqrt(squares[1] / weights[1])};
}

float crown_ambient(const TreeCrown& crown, const glm::vec3& p) {
  const glm::vec3 r = (p - crown.centre) * crown.inverse_half;
  const float squared = std::min(r.x * r.x + r.y * r.y + r.z * r.z, 1.44F);
  return (0.3F + 0.7F / 1.44F * squared) * std::min(std::max(0.8F + 0.2F * r.y, 0.6F), 1.0F);
}

}  // namespace psygen::models
