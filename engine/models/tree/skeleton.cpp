#include "engine/models/tree/skeleton.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/tree/skeleton.cpp"
#include <hwy/foreach_target.h>

#include "engine/models/tree/lanes-inl.hpp"
#include "engine/models/tree/paths.hpp"

#ifndef PSYGEN_MODELS_TREE_SKELETON_ONCE
#define PSYGEN_MODELS_TREE_SKELETON_ONCE
namespace psygen::models {
// 1 / n; element 0 is unused.
inline constexpr std::array<float, kMaxChildren + 1> kInverse = [] {
  std::array<float, kMaxChildren + 1> inverse{};
  for (std::size_t n = 1; n <= kMaxChildren; ++n)
    inverse[n] = 1.0F / static_cast<float>(n);
  return inverse;
}();
}  // namespace psygen::models
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// The parents of the branches in the lanes.
struct Parents {
  VU key;
  Vec3 base, direction, bend;
  VF length, radius;
};
// Parents with these keys. `row_of(r)` looks up row r at the parents' slots.
template <class RowOf>
HWY_INLINE Parents parents_by(VU key, const RowOf& row_of) {
  const auto three = [&](std::size_t r) HWY_ATTR {
    return Vec3{row_of(r), row_of(r + 1), row_of(r + 2)};
  };
  return {key, three(kBase), three(kDirection), three(kBend), row_of(kLength), row_of(kRadius)};
}
// The parents of the branches from slot i on. Siblings are neighbours, so the parents of
// neighbouring branches mostly fit into one vector.
HWY_INLINE Parents parents_of(const TreeSkeleton& s, std::size_t i) {
  const DF d;
  const DU du;
  const std::uint32_t first = s.parent[i];
  const VU slots = hn::Load(du, &s.parent[i]);
  if (HWY_LIKELY(s.parent[i + hn::Lanes(d) - 1] - first < hn::Lanes(d))) {
    const VU lanes = slots - u1(first);
    const auto words = hn::IndicesFromVec(du, lanes);
    const auto numbers = hn::IndicesFromVec(d, lanes);
    return parents_by(hn::TableLookupLanes(hn::LoadU(du, &s.key[first]), words),
                      [&](std::size_t r) HWY_ATTR {
                        return hn::TableLookupLanes(hn::LoadU(d, &s.rows[r][first]), numbers);
                      });
  }
  const auto at = hn::BitCast(DI(), slots);
  return parents_by(hn::GatherIndex(du, s.key.data(), at), [&](std::size_t r) HWY_ATTR {
    return hn::GatherIndex(d, s.rows[r].data(), at);
  });
}

// Computes the branches of a group, whose slots already have parents, ranks and shares.
void shape_group(const TreePlan& plan, const TreeGroup& group, TreeSkeleton& s) {
  const DF d;
  const DU du;
  const KindPlan& k = plan.kinds[group.kind];
  const bool limited = plan.limit_across > 0.0F;
  const VU kind_step = u1(kChildStep * (static_cast<std::uint32_t>(group.kind) * kMaxChildren + 1));
  for (std::size_t i = group.first; i < group.first + group.count; i += hn::Lanes(d)) {
    const Parents parent = parents_of(s, i);
    const VU rank = hn::Load(du, &s.rank[i]);
    const VU key = mix(parent.key + kind_step + rank * u1(kChildStep));
    const VU h0 = number(key, plan.salt, 0), h1 = number(key, plan.salt, 1);
    const VU h2 = number(key, plan.salt, 2), h3 = number(key, plan.salt, 3);
    hn::Store(key, du, &s.key[i]);
    hn::Store(number(key, plan.salt, kDrawNumber), du, &s.draw[i]);

    Vec3 dir = parent.direction;
    const Vec3 bend = parent.bend;
    VF t = f1(k.along_high), a = f1(0.0F);
    if (!k.leader) {
      a = (as_float(rank) + f1(0.7F) * low_part(h0)) * hn::Load(d, &s.share[i]);
      t = t - a * f1(k.along_high - k.along_low);
    }
    const Vec3 base = parent.base + parent.length * (t * dir + (t * t) * bend);
    const Vec3 tangent = unit(dir + (f1(2.0F) * t) * bend);
    dir = tangent;
    if (!k.leader) {
      const VF jitter = f1(1.0F) + f1(k.angle_variation) * (f1(2.0F) * high_part(h0) - f1(1.0F));
      const VF tilt = (f1(k.angle_high) + a * f1(k.angle_low - k.angle_high)) * jitter;
      const VF azimuth = low_part(parent.key) + f1(k.whorl) * as_float(rank) +
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
    VF length = parent.length * (f1(0.85F) + f1(0.3F) * high_part(h1)) *
                (f1(k.length_high) + (f1(1.0F) - t) * f1(k.length_foot - k.length_high));
    if (limited) {
      const Vec3 end = base + length * (dir + bent);
      const VF x = end.x * f1(plan.limit_across), z = end.z * f1(plan.limit_across);
      const VF y = (end.y - f1(plan.envelope_y)) * f1(plan.limit_up);
      length = length / hn::Max(f1(1.0F), x * x + y * y + z * z);
    }
    const VF radius = parent.radius * (f1(1.0F) - t * f1(1.0F - plan.taper)) * f1(k.radius);
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

// Links `count` slots from `to` on to `parent`. Writes up to a vector beyond the end.
HWY_INLINE void link(TreeSkeleton& s, std::uint32_t parent, std::size_t to, std::uint32_t count) {
  const hn::CappedTag<float, 8> d;
  const hn::CappedTag<std::uint32_t, 8> du;
  const auto slot = hn::Set(du, parent);
  const auto share = hn::Set(d, kInverse[count]);
  const auto iota = hn::Iota(du, 0);
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
  std::uint32_t c = 0;
  do {  // even for no slots: the count is unpredictable, and this saves a branch
    hn::StoreU(slot, du, &s.parent[to + c]);
    hn::StoreU(share, d, &s.share[to + c]);
    hn::StoreU(iota + hn::Set(du, c), du, &s.rank[to + c]);
    c += lanes;
  } while (HWY_UNLIKELY(c < count));
}

// Links one slot to each parent of a group.
HWY_INLINE void link_singly(const TreeGroup& parents, TreeSkeleton& s, std::size_t to) {
  const DU du;
  for (std::uint32_t i = 0; i < parents.count; i += static_cast<std::uint32_t>(hn::Lanes(du))) {
    hn::StoreU(counting_from(du, parents.first + i), du, &s.parent[to + i]);
    hn::StoreU(f1(1.0F), DF(), &s.share[to + i]);
    hn::StoreU(u1(0), du, &s.rank[to + i]);
  }
}

// Links the slots of `group` to the parents in groups [first, last).
void link_group(const TreePlan& plan, const TreeGroup& group, std::size_t first, std::size_t last,
                TreeSkeleton& s) {
  std::size_t to = group.first;
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& parents = s.groups[g];
    const GrammarRule* const only = only_rule(*plan.grammar, parents.kind);
    if (!plan.grammar->grows(parents.kind)) continue;
    TreeSkeleton::Words& child = s.child[group.kind];
    if (only != nullptr && only->star != group.kind && only->count[group.kind] == 1) {
      const DU du;
      for (std::uint32_t i = 0; i < parents.count; i += static_cast<std::uint32_t>(hn::Lanes(du)))
        hn::StoreU(counting_from(du, static_cast<std::uint32_t>(to) + i), du,
                   &child[parents.first + i]);
      link_singly(parents, s, to);
      to += parents.count;
      continue;
    }
    for (std::uint32_t p = parents.first; p < parents.first + parents.count; ++p) {
      const std::uint32_t count =
          only == nullptr ? children_of(plan, parents.kind, s.draw[p]).of_kind(group.kind)
                          : only->count[group.kind] + (only->star == group.kind ? s.stars[p] : 0U);
      child[p] = static_cast<std::uint32_t>(to);
      link(s, p, to, count);
      to += count;
    }
  }
}

// Gives the slots behind a group's last one, up to a whole vector, the same parent.
void fill_up_parents(const TreeGroup& group, TreeSkeleton& s) {
  const DU du;
  const std::size_t end = group.first + group.count, rest = end % hn::Lanes(du);
  if (rest == 0) return;
  std::uint32_t* const last = &s.parent[end - rest];
  hn::Store(hn::IfThenElse(hn::FirstN(du, rest), hn::Load(du, last), u1(s.parent[end - 1])), du,
            last);
}

// Writes star_count() of `count` draws to `stars` and returns the sum.
std::uint32_t count_stars(const TreePlan& plan, const GrammarRule& rule, const std::uint32_t* draws,
                          std::uint32_t count, std::uint32_t* stars) {
  const DU du;
  const DI di;
  const auto lanes = static_cast<std::uint32_t>(hn::Lanes(du));
  const int spread = plan.grammar->spread;
  const VU range = u1(static_cast<std::uint32_t>(2 * spread + 1));
  const auto lowest = hn::Set(di, plan.branches - spread), one = hn::Set(di, 1);
  const auto fixed = hn::Set(di, static_cast<std::int32_t>(rule.fixed));
  VU sum = u1(0);
  for (std::uint32_t i = 0; i < count; i += lanes) {
    const VU step = hn::ShiftRight<16>(hn::ShiftRight<16>(hn::LoadU(du, draws + i)) * range);
    const auto drawn = hn::Max(lowest + hn::BitCast(di, step), one);
    VU star = hn::BitCast(du, hn::Max(drawn - fixed, hn::Zero(di)));
    if (count - i < lanes) star = hn::IfThenElseZero(hn::FirstN(du, count - i), star);
    hn::StoreU(star, du, stars + i);
    sum = sum + star;
  }
  return hn::GetLane(hn::SumOfLanes(du, sum));
}

void draw_numbers(std::uint32_t salt, std::uint32_t count, std::uint32_t* keys,
                  std::uint32_t* draws) {
  const DU du;
  for (std::uint32_t i = 0; i < count; i += static_cast<std::uint32_t>(hn::Lanes(du))) {
    const VU key = mix(hn::LoadU(du, keys + i));
    hn::StoreU(key, du, keys + i);
    hn::StoreU(number(key, salt, kDrawNumber), du, draws + i);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {
namespace {

HWY_EXPORT(shape_group);
HWY_EXPORT(link_group);
HWY_EXPORT(fill_up_parents);
HWY_EXPORT(count_stars);
HWY_EXPORT(draw_numbers);

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

// A child that is on a path.
struct PathChild {
  std::uint32_t parent, rank, siblings, share;
  std::uint8_t kind;
};

// Writes the children of the groups [first, last) that are on paths, in order of their parents.
// Returns their number.
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

// Counts the children of the groups [first, last), by kind. Stores each node's number of starred
// children in s.stars.
ChildTotals all_children(const TreePlan& plan, TreeSkeleton& s, std::size_t first,
                         std::size_t last) {
  ChildTotals totals{};
  for (std::size_t g = first; g < last; ++g) {
    const TreeGroup& parents = s.groups[g];
    if (!plan.grammar->grows(parents.kind)) continue;
    count_children(plan, parents.kind, &s.draw[parents.first], parents.count,
                   &s.stars[parents.first], totals);
  }
  return totals;
}

void link_paths(const PathChild* children, std::uint32_t count,
                std::array<std::uint32_t, kMaxKinds> to, TreeSkeleton& s) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const PathChild& child = children[i];
    const std::uint32_t slot = to[child.kind]++;
    s.parent[slot] = child.parent;
    s.rank[slot] = child.rank;
    s.share[slot] = 1.0F / static_cast<float>(child.siblings);
    s.budget[slot] = child.share;
  }
}

}  // namespace

void count_children(const TreePlan& plan, std::size_t kind, const std::uint32_t* draws,
                    std::uint32_t count, std::uint32_t* stars, ChildTotals& totals) {
  const GrammarRule* const only = only_rule(*plan.grammar, kind);
  for (std::size_t c = 0; only != nullptr && c < plan.grammar->kinds; ++c)
    totals[c] += only->count[c] * count;
  if (only != nullptr && only->star != kNoKind)
    totals[only->star] += HWY_DYNAMIC_DISPATCH(count_stars)(plan, *only, draws, count, stars);
  for (std::uint32_t i = 0; only == nullptr && i < count; ++i) {
    const Children children = children_of(plan, kind, draws[i]);
    for (std::size_t c = 0; c < plan.grammar->kinds; ++c)
      totals[c] += children.of_kind(c);
  }
}

void draw_numbers(std::uint32_t salt, std::uint32_t count, std::uint32_t* keys,
                  std::uint32_t* draws) {
  HWY_DYNAMIC_DISPATCH(draw_numbers)(salt, count, keys, draws);
}

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
    if (limited) link_paths(paths, path_count, to, s);
    for (std::size_t g = last; g < s.group_count; ++g) {
      const TreeGroup group = s.groups[g];
      if (!limited) HWY_DYNAMIC_DISPATCH(link_group)(plan, group, first, last, s);
      HWY_DYNAMIC_DISPATCH(fill_up_parents)(group, s);
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
