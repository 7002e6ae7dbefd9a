#include "engine/models/tree/reach.hpp"

#include <cmath>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::models {
namespace {

double d(float v) {
  return static_cast<double>(v);
}

// The largest angle from upright (0 … 180°), as its cosine and sine.
struct Lean {
  double cos = 1, sin = 0;
  double across() const { return cos >= 0 ? sin : 1; }  // largest sine up to this angle
};
constexpr Lean kAnywhere{-1, 0};

Lean sum(const Lean& a, const Lean& b) {
  const Lean total{a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
  return total.sin < 0 || std::min(a.cos, b.cos) <= -1 ? kAnywhere : total;
}

Lean unit(double cos, double sin) {
  const double length = std::sqrt(cos * cos + sin * sin);
  return length > 1e-9 ? Lean{cos / length, sin / length} : kAnywhere;
}

// The largest bend of a branch away from its initial direction, along each axis, over its length.
struct Bend {
  double aside = 0;         // along x or z
  double up = 0, down = 0;  // both above 0
  double most() const { return 1.4143 * aside + std::max(up, down); }
};
Bend bend_of(const KindPlan& k) {
  const double random = 0.25 * d(k.curvature), all = d(k.bend_up);
  return {random, std::max(random + all, 0.0), std::max(random - all, 0.0)};
}
Bend bend_of_trunk(const TreePlan& plan) {
  return {0.25 * d(plan.trunk_curvature), 0, 0};
}

// Returns the largest lean of a branch that starts with this lean.
Lean bent(const Lean& lean, const Bend& bend) {
  const double turn = 2 * bend.most();
  const Lean turned = turn < 1 ? sum(lean, {std::sqrt(1 - turn * turn), turn}) : kAnywhere;
  const double upright = lean.cos - 2 * bend.down;
  if (upright <= 0) return turned;
  const Lean shifted = unit(upright, lean.across() + 2.8286 * bend.aside);
  return shifted.cos > turned.cos ? shifted : turned;
}

// Returns the lean of unit(direction + lift · Y).
Lean lifted(Lean lean, double lift) {
  if (lift <= -1) return kAnywhere;
  if (lift >= 1 && lean.cos < -1 / lift) lean = {-1 / lift, std::sqrt(1 - 1 / (lift * lift))};
  return unit(lean.cos + lift, lean.sin);
}

Lean tilt_of(const KindPlan& k) {
  if (k.leader) return {};
  const double turns = std::max(d(k.angle_high), d(k.angle_low)) * (1 + d(k.angle_variation));
  if (turns >= 0.5) return kAnywhere;
  return {exact_cos_degrees(360 * turns), exact_sin_degrees(360 * turns)};
}

// The largest extents of all branches of one kind at one depth.
struct Worst {
  bool any = false;
  double length = 0;
  Bend bend;
  Lean lean;
  TreeReach reach;
  void add(const Worst& other) {
    if (!any) *this = other;
    length = std::max(length, other.length);
    if (other.lean.cos < lean.cos) lean = other.lean;
    reach.side = std::max(reach.side, other.reach.side);
    reach.top = std::max(reach.top, other.reach.top);
    reach.low = std::min(reach.low, other.reach.low);
  }
};

double length_at(const KindPlan& k, double along) {
  return 1.15 * (d(k.length_high) + (1 - along) * (d(k.length_foot) - d(k.length_high)));
}

Worst child(const Worst& parent, const KindPlan& k, bool of_trunk) {
  Worst c{true, 0, bend_of(k), {}, parent.reach};
  const double first = length_at(k, d(k.along_low)), last = length_at(k, d(k.along_high));
  c.length = parent.length * std::max(first, last);
  c.lean = lifted(sum(bent(parent.lean, parent.bend), tilt_of(k)), d(k.lift));
  c.reach.side += c.length * (c.lean.across() + c.bend.aside);
  c.reach.top += c.length * (1 + c.bend.up);
  const double sinking = std::min(c.lean.cos - c.bend.down, 0.0);
  if (!of_trunk) {
    c.reach.low += c.length * sinking;
    return c;
  }
  // The trunk is at least 0.9 long, and nearly upright.
  c.reach.low = std::min({0.0, 0.89 * d(k.along_low) + parent.length * first * sinking,
                          0.89 * d(k.along_high) + parent.length * last * sinking});
  return c;
}

bool becomes(const Grammar& grammar, std::size_t from, std::size_t to) {
  for (std::size_t r = grammar.first_rule[from]; r < grammar.first_rule[from + 1]; ++r)
    if (grammar.rules[r].count[to] > 0 || grammar.rules[r].star == to) return true;
  return false;
}

// Returns the largest distance between the crown's centre and a branching point of the trunk, in
// radii of the crown.
double trunk_in_crown(const TreePlan& plan, double middle, double radius) {
  double low = 1;
  for (std::size_t k = 0; k < plan.grammar->kinds; ++k)
    if (becomes(*plan.grammar, plan.axiom, k)) low = std::min(low, d(plan.kinds[k].along_low));
  const double up = std::max(std::abs(middle - 0.89 * low), std::abs(1.1 - middle));
  const double side = trunk_side(plan);
  return std::sqrt(up * up + 2 * side * side) / radius;
}

}  // namespace

TreeReach reach_of(const TreePlan& plan) {
  const Grammar& grammar = *plan.grammar;
  const bool limited = plan.limit_across > 0;
  const double size = d(plan.size_m);
  const double middle = d(plan.envelope_y) / size, radius = d(plan.envelope_across) / size;
  const double side = trunk_side(plan);
  TreeReach all{side, 1.1, 0};
  std::array<Worst, kMaxKinds> parents{}, children;
  parents[plan.axiom] = {true, 1.1, bend_of_trunk(plan), {0.9937, 0.1125}, all};
  double in_crown = limited ? trunk_in_crown(plan, middle, radius) : 0;
  for (int depth = 1; depth <= plan.iterations; ++depth) {
    children = {};
    double longest = 0, bend = 0;
    for (std::size_t p = 0; p < grammar.kinds; ++p)
      for (std::size_t k = 0; parents[p].any && k < grammar.kinds; ++k) {
        if (!becomes(grammar, p, k)) continue;
        children[k].add(child(parents[p], plan.kinds[k], depth == 1));
        longest = std::max(longest, children[k].length);
        bend = std::max(bend, children[k].bend.most());
      }
    if (longest <= 0) break;
    TreeReach now;
    for (const Worst& c : children) {
      if (!c.any) continue;
      now.side = std::max(now.side, c.reach.side);
      now.top = std::max(now.top, c.reach.top);
      now.low = std::min(now.low, c.reach.low);
    }
    if (limited) {
      in_crown = reach_in_crown(in_crown, longest / radius, bend);
      now.side = std::min(now.side, radius * in_crown);
      now.top = std::min(now.top, middle + radius * in_crown);
      now.low = std::max(now.low, middle - radius * in_crown);
    }
    all.side = std::max(all.side, now.side);
    all.top = std::max(all.top, now.top);
    all.low = std::min(all.low, now.low);
    parents = children;
  }
  return all;
}

}  // namespace psygen::models
