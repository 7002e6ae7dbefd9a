// Follows only some paths through a tree, for coarse levels of detail. Every node distributes its
// paths among its children, in proportion to the expected number of tips under each. Pure, any
// thread. Internal to trees. docs/models.md, "Tree".
#pragma once

#include "engine/models/tree/random.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {

// True if the grammar puts leaves on the branches of a group.
inline bool bears_leaves(const TreePlan& plan, const TreeGroup& group) {
  const LeavesOn on = plan.kinds[group.kind].leaves;
  return on == LeavesOn::kAll || (on == LeavesOn::kTips && group.tip);
}

// True if the grammar puts leaves on any of the grown branches. If not, the tips bear the leaves.
inline bool has_bearers(const TreePlan& plan, const TreeSkeleton& s) {
  for (std::size_t g = 0; plan.foliage.near != nullptr && g < s.group_count; ++g)
    if (bears_leaves(plan, s.groups[g])) return true;
  return false;
}

// Distributes the paths of a node among its children by systematic sampling. With weights w of sum
// W, B paths and a phase φ from the node's draw, child j gets ⌊B (w_0 + … + w_j) / W + φ⌋ − ⌊B (w_0
// + … + w_{j−1}) / W + φ⌋.
class Shares {
 public:
  // `remaining`: iterations left below the children. `plan` must outlive the object.
  Shares(const TreePlan& plan, const Children& children, std::uint32_t budget, int remaining,
         std::uint32_t draw)
      : plan_(plan), budget_(budget), remaining_(static_cast<std::size_t>(remaining)) {
    for (std::size_t kind = 0; kind < plan.grammar->kinds; ++kind)
      total_ += std::uint64_t{children.of_kind(kind)} * weight(kind);
    needed_ = total_ * (65536U - (draw & 0xFFFFU));
  }
  // Returns the paths of the next child, which is of this kind. Call it child after child, in order
  // of kind and rank.
  std::uint32_t next(std::size_t kind) {
    sum_ += weight(kind);
    std::uint32_t share = 0;
    for (; (sum_ * budget_ << 16) >= needed_; needed_ += total_ << 16)
      ++share;
    return share;
  }

 private:
  std::uint64_t weight(std::size_t kind) const {
    return plan_.weights == nullptr ? 1 : (*plan_.weights)[kind][remaining_];
  }
  const TreePlan& plan_;
  std::uint64_t budget_;
  std::size_t remaining_;
  std::uint64_t total_ = 0, sum_ = 0, needed_ = 0;
};

// Visits the children of a node that are on its paths, in order of kind and rank: visit(kind, rank,
// children of that kind, paths).
template <class Visit>
void for_children(const TreePlan& plan, std::size_t kind, std::uint32_t draw, std::uint32_t budget,
                  int remaining, const Visit& visit) {
  const Children children = children_of(plan, kind, draw);
  if (budget == 1 && plan.weights == nullptr && children.total() > 0) {
    // The first child j with (j + 1) / total + φ >= 1.
    std::uint32_t rank = (children.total() * (65536U - (draw & 0xFFFFU)) + 65535U) / 65536U - 1U;
    std::size_t c = 0;
    for (; rank >= children.of_kind(c); ++c)
      rank -= children.of_kind(c);
    visit(c, rank, children.of_kind(c), 1U);
    return;
  }
  Shares shares(plan, children, budget, remaining, draw);
  for (std::size_t c = 0; c < plan.grammar->kinds && budget > 0; ++c) {
    const std::uint32_t count = children.of_kind(c);
    for (std::uint32_t rank = 0; rank < count && budget > 0; ++rank) {
      const std::uint32_t share = shares.next(c);
      budget -= share;
      if (share > 0) visit(c, rank, count, share);
    }
  }
}

}  // namespace psygen::models
