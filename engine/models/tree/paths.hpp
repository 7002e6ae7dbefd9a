// Following only some paths through a tree, for coarse levels of detail: a number of paths is
// shared out among the children of every node by the tips that are expected under each. Internal to
// trees.
#pragma once

#include "engine/models/tree/random.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {

using ChildTotals = std::array<std::uint32_t, kMaxKinds>;

inline bool bears_leaves(const TreePlan& plan, const TreeGroup& group) {
  const LeavesOn on = plan.kinds[group.kind].leaves;
  return on == LeavesOn::kAll || (on == LeavesOn::kTips && group.tip);
}

// Whether leaves grow on these branches as the grammar says; it may be that none of them bears any:
// then the tips do.
inline bool has_bearers(const TreePlan& plan, const TreeSkeleton& s) {
  for (std::size_t g = 0; plan.foliage.near != nullptr && g < s.group_count; ++g)
    if (bears_leaves(plan, s.groups[g])) return true;
  return false;
}

// How a node's paths are shared out among its children: child after child, in order of kind and
// rank, `next` gives the paths of one. Systematic sampling: with weights w of sum W and a phase φ
// from the node's draw, child j gets ⌊B (w_0 + … + w_j) / W + φ⌋ − ⌊B (w_0 + … + w_{j−1}) / W + φ⌋.
class Shares {
 public:
  Shares(const TreePlan& plan, const Children& children, std::uint32_t budget, int remaining,
         std::uint32_t draw)
      : plan_(plan), budget_(budget), remaining_(static_cast<std::size_t>(remaining)) {
    for (std::size_t kind = 0; kind < plan.grammar->kinds; ++kind)
      total_ += std::uint64_t{children.of_kind(kind)} * weight(kind);
    needed_ = total_ * (65536U - (draw & 0xFFFFU));
  }
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

// Children of a path-limited tree, one by one.
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
