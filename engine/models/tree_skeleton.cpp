#include "engine/models/tree_skeleton.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/tree_skeleton.cpp"
#include <hwy/foreach_target.h>

#include "engine/models/tree_lanes-inl.hpp"
#include "engine/models/tree_paths.hpp"

#ifndef PSYGEN_MODELS_TREE_SKELETON_ONCE
#define PSYGEN_MODELS_TREE_SKELETON_ONCE
namespace psygen::models {
// 1 / n.
inline constexpr std::array<float, kMaxChildren + 1> kInverse = [] {
  std::array<float, kMaxChildren + 1> inverse{};
  for (std::size_t n = 1; n <= kMaxChildren; ++n)
    inverse[n] = 1.0F / static_cast<float>(n);
  return inverse;
}();
}  // namespace psygen::models
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models {
namespace HWY_NAMESPACE {

// From slots that hold their parents (their key, place, radius and so on), their rank and share, to
// branches of `kind`.
void shape_group(const TreePlan& plan, const TreeGroup& group, TreeSkeleton& s) {
  const DF d;
  const DU du;
  const KindPlan& k = plan.kinds[group.kind];
  const bool limited = plan.limit_across > 0.0F;
  const VU kind_step = u1(kChildStep * (static_cast<std::uint32_t>(group.kind) * kMaxChildren + 1));
  for (std::size_t i = group.first; i < group.first + group.count; i += hn::Lanes(d)) {
    const VU parent = hn::Load(du, &s.key[i]);
    const VU rank = hn::Load(du, &s.rank[i]);
    const VU key = mix(parent + kind_step + rank * u1(kChildStep));
    const VU h0 = number(key, plan.salt, 0), h1 = number(key, plan.salt, 1);
    const VU h2 = number(key, plan.salt, 2), h3 = number(key, plan.salt, 3);
    hn::Store(key, du, &s.key[i]);
    hn::Store(number(key, plan.salt, kDrawNumber), du, &s.draw[i]);

    Vec3 dir =
        load3(&s.rows[kDirection][i], &s.rows[kDirection + 1][i], &s.rows[kDirection + 2][i]);
    const Vec3 bend = load3(&s.rows[kBend][i], &s.rows[kBend + 1][i], &s.rows[kBend + 2][i]);
    const VF parent_length = hn::Load(d, &s.rows[kLength][i]);
    VF t = f1(k.along_high), a = f1(0.0F);
    if (!k.leader) {
      a = (as_float(rank) + f1(0.7F) * low_part(h0)) * hn::Load(d, &s.share[i]);
      t = t - a * f1(k.along_high - k.along_low);
    }
    Vec3 base = load3(&s.rows[kBase][i], &s.rows[kBase + 1][i], &s.rows[kBase + 2][i]);
    base = base + parent_length * (t * dir + (t * t) * bend);
    const Vec3 tangent = unit(dir + (f1(2.0F) * t) * bend);
    dir = tangent;
    if (!k.leader) {
      const VF jitter = f1(1.0F) + f1(k.angle_variation) * (f1(2.0F) * high_part(h0) - f1(1.0F));
      const VF tilt = (f1(k.angle_high) + a * f1(k.angle_low - k.angle_high)) * jitter;
      const VF azimuth = low_part(parent) + f1(k.whorl) * as_float(rank) +
                         f1(0.3F * k.angle_variation) * (low_part(h1) - f1(0.5F));
      Vec3 u, v;
      frame_around(tangent, u, v);
      const Vec3 side = cos_turns(azimuth) * u + sin_turns(azimuth) * v;
      dir = cos_turns(tilt) * tangent + sin_turns(tilt) * side;
    }
    dir.y = dir.y + f1(k.lift);
    dir = unit(dir);

    const VF half = f1(0.5F), crooked = f1(0.5F * k.curvature);
    const Vec3 bent{crooked * (low_part(h2) - half),
                    crooked * (high_part(h2) - half) + f1(k.bend_up),
                    crooked * (low_part(h3) - half)};
    VF length = parent_length * (f1(0.85F) + f1(0.3F) * high_part(h1)) *
                (f1(k.length_high) + (f1(1.0F) - t) * f1(k.length_foot - k.length_high));
    if (limited) {
      const Vec3 end = base + length * (dir + bent);
      const VF x = end.x * f1(plan.limit_across), z = end.z * f1(plan.limit_across);
      const VF y = (end.y - f1(plan.envelope_y)) * f1(plan.limit_up);
      length = length / hn::Max(f1(1.0F), x * x + y * y + z * z);
    }
    const VF radius =
        hn::Load(d, &s.rows[kRadius][i]) * (f1(1.0F) - t * f1(1.0F - plan.taper)) * f1(k.radius);
    hn::Store(base.x, d, &s.rows[kBase][i]);
    hn::Store(base.y, d, &s.rows[kBase + 1][i]);
    hn::Store(base.z, d, &s.rows[kBase + 2][i]);
    hn::Store(dir.x, d, &s.rows[kDirection][i]);
    hn::Store(dir.y, d, &s.rows[kDirection + 1][i]);
    hn::Store(dir.z, d, &s.rows[kDirection + 2][i]);
    hn::Store(bent.x, d, &s.rows[kBend][i]);
    hn::Store(bent.y, d, &s.rows[kBend + 1][i]);
    hn::Store(bent.z, d, &s.rows[kBend + 2][i]);
    hn::Store(length, d, &s.rows[kLength][i]);
    hn::Store(radius, d, &s.rows[kRadius][i]);
  }
}

// Writes a parent into `count` slots from `to`, and perhaps into a few more.
HWY_INLINE void hand_down(TreeSkeleton& s, std::size_t parent, std::size_t to,
                          std::uint32_t count) {
  const hn::CappedTag<float, 4> d;
  const hn::CappedTag<std::uint32_t, 4> du;
  const auto key = hn::Set(du, s.key[parent]);
  const auto share = hn::Set(d, kInverse[count]);
  const auto iota = hn::Iota(du, 0);
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  for (std::uint32_t c = 0; c < count; c += lanes) {
    hn::StoreU(key, du, &s.key[to + c]);
    hn::StoreU(share, d, &s.share[to + c]);
    hn::StoreU(iota + hn::Set(du, c), du, &s.rank[to + c]);
#pragma GCC unroll 11
    for (std::size_t r = 0; r < kTreeRows; ++r)
      hn::StoreU(hn::Set(d, s.rows[r][parent]), d, &s.rows[r][to + c]);
  }
}

// Every parent of a group into one slot.
HWY_INLINE void hand_down_singly(const TreeGroup& parents, TreeSkeleton& s, std::size_t to) {
  const DF d;
  const DU du;
  for (std::size_t i = 0; i < parents.count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Load(du, &s.key[parents.first + i]), du, &s.key[to + i]);
    hn::StoreU(f1(1.0F), d, &s.share[to + i]);
    hn::StoreU(u1(0), du, &s.rank[to + i]);
    for (std::size_t r = 0; r < kTreeRows; ++r)
      hn::StoreU(hn::Load(d, &s.rows[r][parents.first + i]), d, &s.rows[r][to + i]);
  }
}

// Fills the slots of `group` from the parents in groups [first, last).
void hand_down_all(const TreePlan& plan, const TreeGroup& group, std::size_t first,
                   std::size_t last, TreeSkeleton& s) {
  std::size_t to = group.first;
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& parents = s.groups[g];
    const Grammar& grammar = *plan.grammar;
    const std::size_t rules =
        grammar.first_rule[parents.kind + 1U] - grammar.first_rule[parents.kind];
    if (rules == 0) continue;
    const GrammarRule& only = grammar.rules[grammar.first_rule[parents.kind]];
    if (rules == 1 && only.star != group.kind) {
      const std::uint32_t count = only.count[group.kind];
      std::uint32_t* const child = &s.child[group.kind][parents.first];
      for (std::uint32_t p = 0; p < parents.count; ++p)
        child[p] = static_cast<std::uint32_t>(to) + p * count;
      if (count == 1) {
        hand_down_singly(parents, s, to);
        to += parents.count;
      } else if (count > 1) {
        for (std::uint32_t p = 0; p < parents.count; ++p, to += count)
          hand_down(s, parents.first + p, to, count);
      }
      continue;
    }
    for (std::uint32_t p = parents.first; p < parents.first + parents.count; ++p) {
      const std::uint32_t count = children_of(plan, parents.kind, s.draw[p]).of_kind(group.kind);
      s.child[group.kind][p] = static_cast<std::uint32_t>(to);
      hand_down(s, p, to, count);
      to += count;
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace psygen::models
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {
namespace {

HWY_EXPORT(shape_group);
HWY_EXPORT(hand_down_all);

void plant(const TreePlan& plan, TreeSkeleton& s) {
  const std::uint32_t h[4] = {number_of(plan.key, plan.salt, 0), number_of(plan.key, plan.salt, 1),
                              number_of(plan.key, plan.salt, 2), number_of(plan.key, plan.salt, 3)};
  const float x = 0.16F * (low_fraction(h[0]) - 0.5F), z = 0.16F * (high_fraction(h[0]) - 0.5F);
  const float scale = 1.0F / std::sqrt(x * x + 1.0F + z * z);
  const float crooked = 0.5F * plan.trunk_curvature;
  const float values[kTreeRows] = {0.0F,
                                   0.0F,
                                   0.0F,
                                   x * scale,
                                   scale,
                                   z * scale,
                                   crooked * (low_fraction(h[2]) - 0.5F),
                                   0.0F,
                                   crooked * (low_fraction(h[3]) - 0.5F),
                                   plan.size_m * (0.9F + 0.2F * low_fraction(h[1])),
                                   plan.radius_m * (0.85F + 0.3F * high_fraction(h[1]))};
  for (std::size_t r = 0; r < kTreeRows; ++r)
    s.rows[r][0] = values[r];
  s.key[0] = plan.key;
  s.draw[0] = number_of(plan.key, plan.salt, kDrawNumber);
  s.groups[0] = {0, 1, plan.axiom, 0, false};
  s.group_count = 1;
  s.depth = 0;
}

void copy_parent(TreeSkeleton& s, std::uint32_t from, std::uint32_t to) {
  for (auto& row : s.rows)
    row[to] = row[from];
  s.key[to] = s.key[from];
}

// A child that is on a path.
struct PathChild {
  std::uint32_t parent, rank, siblings, share;
  std::uint8_t kind;
};

// The children of the groups [first, last) that are on paths, in order of their parents.
std::uint32_t path_children(const TreePlan& plan, const TreeSkeleton& s, std::size_t first,
                            std::size_t last, int remaining, PathChild* out) {
  std::uint32_t count = 0;
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& parents = s.groups[g];
    if (!plan.grammar->grows(parents.kind)) continue;
    for (std::uint32_t p = parents.first; p < parents.first + parents.count; ++p)
      for_children(
          plan, parents.kind, s.draw[p], s.budget[p], remaining,
          [&](std::size_t c, std::uint32_t rank, std::uint32_t siblings, std::uint32_t share) {
            out[count++] = {p, rank, siblings, share, static_cast<std::uint8_t>(c)};
          });
  }
  return count;
}

// The children of all nodes of the groups [first, last), by kind; notes how many each node has of
// the kind that fills up.
ChildTotals all_children(const TreePlan& plan, TreeSkeleton& s, std::size_t first,
                         std::size_t last) {
  ChildTotals totals{};
  const Grammar& grammar = *plan.grammar;
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& parents = s.groups[g];
    const std::uint32_t from = parents.first, to = from + parents.count;
    const std::size_t rules =
        grammar.first_rule[parents.kind + 1U] - grammar.first_rule[parents.kind];
    if (rules == 0) continue;
    const GrammarRule& only = grammar.rules[grammar.first_rule[parents.kind]];
    if (rules > 1) {
      for (std::uint32_t p = from; p < to; ++p) {
        const Children children = children_of(plan, parents.kind, s.draw[p]);
        for (std::size_t c = 0; c < grammar.kinds; ++c)
          totals[c] += children.of_kind(c);
      }
      continue;
    }
    for (std::size_t c = 0; c < grammar.kinds; ++c)
      totals[c] += only.count[c] * parents.count;
    if (only.star == kNoKind) continue;
    std::uint32_t stars = 0;
    for (std::uint32_t p = from; p < to; ++p)
      stars += star_count(plan, only, s.draw[p]);
    totals[only.star] += stars;
  }
  return totals;
}

void hand_down_paths(const PathChild* children, std::uint32_t count,
                     std::array<std::uint32_t, kMaxKinds> to, TreeSkeleton& s) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const PathChild& child = children[i];
    const std::uint32_t slot = to[child.kind]++;
    copy_parent(s, child.parent, slot);
    s.rank[slot] = child.rank;
    s.share[slot] = 1.0F / static_cast<float>(child.siblings);
    s.budget[slot] = child.share;
  }
}

}  // namespace

void grow_tree(const TreePlan& plan, int depth, std::uint32_t max_tips, TreeSkeleton& s) {
  plant(plan, s);
  const bool limited = max_tips != kWholeTree;
  s.budget[0] = max_tips;
  std::size_t first = 0;
  std::uint32_t slot = kTreeLanes, nodes = 1;
  for (int d = 1; d <= depth; ++d) {
    const std::size_t last = s.group_count;
    const int remaining = plan.iterations - d;
    PathChild paths[kMaxPaths];
    std::uint32_t path_count = 0;
    ChildTotals totals{};
    if (limited) {
      path_count = path_children(plan, s, first, last, remaining, paths);
      for (std::uint32_t i = 0; i < path_count; ++i)
        ++totals[paths[i].kind];
    } else {
      totals = all_children(plan, s, first, last);
    }
    std::uint32_t all = 0;
    for (const std::uint32_t n : totals)
      all += n;
    if (all == 0 || nodes + all > kMaxTreeNodes) break;
    nodes += all;
    std::array<std::uint32_t, kMaxKinds> to{};
    for (std::size_t c = 0; c < plan.grammar->kinds; ++c) {
      if (totals[c] == 0) continue;
      to[c] = slot;
      s.groups[s.group_count++] = {slot, totals[c], static_cast<std::uint8_t>(c),
                                   static_cast<std::uint8_t>(d), false};
      slot += (totals[c] + kTreeLanes - 1) / kTreeLanes * kTreeLanes;
    }
    if (limited) hand_down_paths(paths, path_count, to, s);
    for (std::size_t g = last; g < s.group_count; ++g) {
      const TreeGroup group = s.groups[g];
      if (!limited) HWY_DYNAMIC_DISPATCH(hand_down_all)(plan, group, first, last, s);
    }
    for (std::size_t g = last; g < s.group_count; ++g)
      HWY_DYNAMIC_DISPATCH(shape_group)(plan, s.groups[g], s);
    s.depth = d;
    first = last;
  }
  for (std::size_t g = 0; g < s.group_count; ++g)
    s.groups[g].tip = s.groups[g].depth == s.depth || !plan.grammar->grows(s.groups[g].kind);
}

void find_paths(const TreePlan& plan, const TreeSkeleton& s, std::uint32_t max_tips,
                TreePaths& out) {
  out.nodes[0] = {0, max_tips, plan.axiom, 0};
  out.count = 1;
  out.depth = 0;
  std::uint32_t first = 0;
  for (int d = 1; d <= s.depth; ++d) {
    TreePaths::Node found[kMaxPaths];
    std::uint32_t count = 0;
    ChildTotals totals{};
    for (std::uint32_t i = first; i < out.count; ++i) {
      const TreePaths::Node& parent = out.nodes[i];
      if (!plan.grammar->grows(parent.kind)) continue;
      for_children(plan, parent.kind, s.draw[parent.slot], parent.budget, plan.iterations - d,
                   [&](std::size_t c, std::uint32_t rank, std::uint32_t, std::uint32_t share) {
                     found[count++] = {s.child[c][parent.slot] + rank, share,
                                       static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(d)};
                     ++totals[c];
                   });
    }
    if (count == 0) break;
    first = out.count;
    std::array<std::uint32_t, kMaxKinds> to{};
    for (std::size_t c = 0; c < plan.grammar->kinds; ++c) {
      to[c] = out.count;
      out.count += totals[c];
    }
    for (std::uint32_t i = 0; i < count; ++i)
      out.nodes[to[found[i].kind]++] = found[i];
    out.depth = d;
  }
}

}  // namespace psygen::models
#endif  // HWY_ONCE
