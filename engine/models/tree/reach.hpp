// How far the branches of a tree can be from its foot, whatever its seed: worked out from the plan
// by following the worst branch of each kind from depth to depth. For bounds(), which vertices are
// packed in: no libm, the same bits everywhere. Not the box of one tree; sprays and radii of
// branches come on top. Pure.
#pragma once

#include <algorithm>

#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Of the middle lines of all branches, in lengths of the trunk (plan.size_m) from its foot.
struct TreeReach {
  double side = 0;  // along x or z
  double top = 0, low = 0;
};

// `plan` needs its grammar, kinds, trunk and envelope; the envelope's size_m is that of the plan.
TreeReach reach_of(const TreePlan& plan);

// Branches are shortened by the square of where they would end, if that is outside of the sphere
// that limits the crown. How far from its centre one can come that begins within `start` and is at
// most `length` long, in radii of the sphere; `bend`: the most that it is crooked, over its length.
inline double reach_in_crown(double start, double length, double bend) {
  double end = start + length * (1 + bend);
  if (end > 1) {
    const double worst = std::clamp(2 * start, 1.0, end);
    end = start * (1 - 1 / (worst * worst)) + 1 / worst;
  }
  const double sag = length * bend, gain = end - start;
  return sag > gain ? end + (sag - gain) * (sag - gain) / (4 * sag) : end;
}

// The most that the trunk's end is off its foot along x or z, in lengths of the trunk.
inline double trunk_side(const TreePlan& plan) {
  return 1.1 * (0.08 + 0.25 * static_cast<double>(plan.trunk_curvature));
}

// The farthest vertex of a ring around a crooked branch, over the branch's radius at its foot.
inline double ring_reach(double most_bend) {
  return 1.15 * (1 + 2 * most_bend * most_bend);  // above sqrt(1 + (2 bend)²)
}

}  // namespace psygen::models
