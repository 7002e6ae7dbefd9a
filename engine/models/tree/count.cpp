// Counts the branches of a tree by hashing alone, for the exact sizes of meshes before synthesis.
#include "engine/models/kit/scratch.hpp"
#include "engine/models/tree/paths.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {
namespace {

// The nodes of one depth, kind by kind. Only kinds that grow further are kept.
struct Generation {
  using Words = std::array<std::uint32_t, kMaxTreeNodes + 2 * kTreeLanes>;
  alignas(64) Words draw;
  alignas(64) Words key;
  alignas(64) Words budget;
  alignas(64) Words stars;                         // whole trees only, for kinds with one rule
  std::array<std::uint32_t, kMaxKinds + 1> first;  // of each kind
  Generation() {}
  std::uint32_t count(std::size_t kind) const { return first[kind + 1] - first[kind]; }
};

// Counts the children of a generation by kind, and makes the next generation.
class Counter {
 public:
  Counter(const TreePlan& plan, bool limited) : plan_(plan), limited_(limited) {}

  ChildTotals totals(Generation& parents, int remaining) const {
    ChildTotals totals{};
    for (std::size_t kind = 0; kind < plan_.grammar->kinds; ++kind) {
      const std::uint32_t count = parents.count(kind), first = parents.first[kind];
      if (!limited_ && count > 0)
        count_children(plan_, kind, &parents.draw[first], count, &parents.stars[first], totals);
      for (std::uint32_t p = first; limited_ && p < first + count; ++p)
        for_children(
            plan_, kind, parents.draw[p], parents.budget[p], remaining,
            [&](std::size_t c, std::uint32_t, std::uint32_t, std::uint32_t) { ++totals[c]; });
    }
    return totals;
  }

  void raise(const Generation& parents, const ChildTotals& totals, int remaining,
             Generation& out) const {
    out.first[0] = 0;
    for (std::size_t c = 0; c < kMaxKinds; ++c)
      out.first[c + 1] = out.first[c] + (plan_.grammar->grows(c) ? totals[c] : 0);
    limited_ ? follow_paths(parents, remaining, out) : append_children(parents, out);
    draw_numbers(plan_.salt, out.first[kMaxKinds], out.key.data(), out.draw.data());
  }

 private:
  void follow_paths(const Generation& parents, int remaining, Generation& out) const {
    std::array<std::uint32_t, kMaxKinds> to;
    std::copy_n(out.first.begin(), kMaxKinds, to.begin());
    for (std::size_t kind = 0; kind < plan_.grammar->kinds; ++kind)
      for (std::uint32_t p = parents.first[kind]; p < parents.first[kind + 1]; ++p)
        for_children(plan_, kind, parents.draw[p], parents.budget[p], remaining,
                     [&](std::size_t c, std::uint32_t rank, std::uint32_t, std::uint32_t share) {
                       if (!plan_.grammar->grows(c)) return;
                       out.key[to[c]] = unmixed_child_key(parents.key[p], c, rank);
                       out.budget[to[c]++] = share;
                     });
  }

  // Works kind by kind: values written beyond the end of one kind are overwritten by the next.
  void append_children(const Generation& parents, Generation& out) const {
    for (std::size_t c = 0; c < plan_.grammar->kinds; ++c) {
      if (!plan_.grammar->grows(c)) continue;
      std::uint32_t* to = &out.key[out.first[c]];
      for (std::size_t kind = 0; kind < plan_.grammar->kinds; ++kind) {
        const GrammarRule* const only = only_rule(*plan_.grammar, kind);
        for (std::uint32_t p = parents.first[kind]; p < parents.first[kind + 1]; ++p) {
          const std::uint32_t count =
              only == nullptr ? children_of(plan_, kind, parents.draw[p]).of_kind(c)
                              : only->count[c] + (only->star == c ? parents.stars[p] : 0U);
          const std::uint32_t first = unmixed_child_key(parents.key[p], c, 0);
          std::uint32_t rank = 0;
          do {  // at least once: the count is unpredictable, and this saves a branch
            for (std::uint32_t i = 0; i < kAtOnce; ++i)
              to[rank + i] = first + kChildStep * (rank + i);
            rank += kAtOnce;
          } while (rank < count);
          to += count;
        }
      }
    }
  }

  static constexpr std::uint32_t kAtOnce = 4;
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
  const Scratch<std::array<Generation, 2>> scratch;
  std::array<Generation, 2>& generations = *scratch;
  plant(plan, max_tips, generations[0]);
  const int deepest = std::min(depth, last);
  for (int d = 1; d <= deepest; ++d) {
    Generation& parents = generations[static_cast<std::size_t>(d + 1) % 2];
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
    if (d < deepest)
      counter.raise(parents, totals, remaining, generations[static_cast<std::size_t>(d) % 2]);
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
