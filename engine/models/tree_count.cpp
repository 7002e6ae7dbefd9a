// How many branches a tree has, by hashing alone: the exact sizes of meshes before anything grows.
#include "engine/models/tree_paths.hpp"
#include "engine/models/tree_skeleton.hpp"

namespace psygen::models {
namespace {

// The nodes of one depth. Only what grows further is kept.
struct Generation {
  std::array<std::uint32_t, kMaxTreeNodes> draw;
  std::array<std::uint32_t, kMaxTreeNodes> key;
  std::array<std::uint32_t, kMaxTreeNodes> budget;
  std::array<std::uint32_t, kMaxKinds + 1> first;  // of each kind
  Generation() {}
};

// The children of `parents` by kind, and, where wanted, the next generation.
class Counter {
 public:
  Counter(const TreePlan& plan, bool limited) : plan_(plan), limited_(limited) {}

  ChildTotals totals(const Generation& parents, int remaining) const {
    ChildTotals totals{};
    visit(parents, remaining, [&](std::size_t kind, std::uint32_t p) {
      if (limited_) {
        for_children(
            plan_, kind, parents.draw[p], parents.budget[p], remaining,
            [&](std::size_t c, std::uint32_t, std::uint32_t, std::uint32_t) { ++totals[c]; });
        return;
      }
      const Children children = children_of(plan_, kind, parents.draw[p]);
      for (std::size_t c = 0; c < plan_.grammar->kinds; ++c)
        totals[c] += children.of_kind(c);
    });
    return totals;
  }

  void raise(const Generation& parents, const ChildTotals& totals, int remaining,
             Generation& out) const {
    out.first[0] = 0;
    for (std::size_t c = 0; c < kMaxKinds; ++c)
      out.first[c + 1] = out.first[c] + (plan_.grammar->grows(c) ? totals[c] : 0);
    std::array<std::uint32_t, kMaxKinds> to;
    std::copy_n(out.first.begin(), kMaxKinds, to.begin());
    const auto add = [&](std::size_t c, std::uint32_t key, std::uint32_t budget) {
      const std::uint32_t i = to[c]++;
      out.key[i] = key;
      out.draw[i] = number_of(key, plan_.salt, kDrawNumber);
      out.budget[i] = budget;
    };
    visit(parents, remaining, [&](std::size_t kind, std::uint32_t p) {
      const std::uint32_t key = parents.key[p];
      if (limited_) {
        for_children(plan_, kind, parents.draw[p], parents.budget[p], remaining,
                     [&](std::size_t c, std::uint32_t rank, std::uint32_t, std::uint32_t share) {
                       if (plan_.grammar->grows(c)) add(c, child_key(key, c, rank), share);
                     });
        return;
      }
      const Children children = children_of(plan_, kind, parents.draw[p]);
      for (std::size_t c = 0; c < plan_.grammar->kinds; ++c) {
        if (!plan_.grammar->grows(c)) continue;
        for (std::uint32_t rank = 0; rank < children.of_kind(c); ++rank)
          add(c, child_key(key, c, rank), kWholeTree);
      }
    });
  }

 private:
  template <class Visit>
  void visit(const Generation& parents, int, const Visit& visit) const {
    for (std::size_t kind = 0; kind < plan_.grammar->kinds; ++kind)
      for (std::uint32_t p = parents.first[kind]; p < parents.first[kind + 1]; ++p)
        visit(kind, p);
  }
  const TreePlan& plan_;
  bool limited_;
};

void plant(const TreePlan& plan, std::uint32_t max_tips, Generation& out) {
  out.first.fill(0);
  for (std::size_t c = plan.axiom; c < kMaxKinds; ++c)
    out.first[c + 1] = plan.grammar->grows(plan.axiom) ? 1 : 0;
  out.key[0] = plan.key;
  out.draw[0] = number_of(plan.key, plan.salt, kDrawNumber);
  out.budget[0] = max_tips;
}

}  // namespace

TreeCount count_tree(const TreePlan& plan, int depth, std::uint32_t max_tips, int last) {
  TreeCount result;
  result.groups[0] = {0, 1, plan.axiom, 0, false};
  result.group_count = 1;
  result.nodes = 1;
  const Counter counter(plan, max_tips != kWholeTree);
  Generation generations[2];
  plant(plan, max_tips, generations[0]);
  const int deepest = std::min(depth, last);
  for (int d = 1; d <= deepest; ++d) {
    const Generation& parents = generations[(d + 1) % 2];
    const int remaining = plan.iterations - d;
    const ChildTotals totals = counter.totals(parents, remaining);
    std::uint32_t all = 0;
    for (const std::uint32_t n : totals)
      all += n;
    if (all == 0 || result.nodes + all > kMaxTreeNodes) break;
    for (std::size_t c = 0; c < plan.grammar->kinds; ++c) {
      if (totals[c] > 0)
        result.groups[result.group_count++] = {0, totals[c], static_cast<std::uint8_t>(c),
                                               static_cast<std::uint8_t>(d), false};
    }
    result.nodes += all;
    result.depth = d;
    if (d < deepest) counter.raise(parents, totals, remaining, generations[d % 2]);
  }
  result.bearers = result.tips = 0;
  for (std::size_t g = 0; g < result.group_count; ++g) {
    TreeGroup& group = result.groups[g];
    group.tip = group.depth == std::min(depth, result.depth) && last >= depth;
    group.tip = group.tip || !plan.grammar->grows(group.kind);
    if (group.tip) result.tips += group.count;
    if (bears_leaves(plan, group)) result.bearers += group.count;
  }
  return result;
}

int tree_depth(const TreePlan& plan) {
  return plan.always_complete ? plan.iterations : count_tree(plan, plan.iterations).depth;
}

}  // namespace psygen::models
