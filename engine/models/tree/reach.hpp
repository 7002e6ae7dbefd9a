// The largest distance of branches from a tree's base point, over all seeds. Computed from the plan
// by following the worst branch of each kind from depth to depth. For bounds(), in which vertices
// are packed: no libm, the same bits everywhere. Not the bounds of one tree, and without sprays and
// radii of branches. Pure, any thread.
#pragma once

#include <algorithm>

#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Extents of the centre lines of all branches, in lengths of the trunk (plan.size_m) from the base
// point.
struct TreeReach {
  double side = 0;          // largest |x| or |z|
  double top = 0, low = 0;  // largest and smallest y
};

// Returns the reach of a plan. It needs the grammar, kinds, trunk and envelope, all for the same
// size_m. Time is linear in iterations · kinds².
TreeReach reach_of(const TreePlan& plan);

// A branch that would end outside the sphere around the crown is shortened: its length is divided
// by the square of that end's distance. Returns the largest distance from the centre that a branch
// can reach if it begins within `start` and is at most `length` long, in radii of the sphere.
// `bend` is its largest deviation from a straight line, over its length.
inline double reach_in_crown(double start, double length, double bend) {
  double end = start + length * (1 + bend);
  if (end > 1) {
    const double worst = std::clamp(2 * start, 1.0, end);
    end = start * (1 - 1 / (worst * worst)) + 1 / worst;
  }
  const double sag = length * bend, gain = end - start;
  return sag > gain ? end + (sag - gain) * (sag - gain) / (4 * sag) : end;
}

// The largest offset of the trunk's end from its base along x or z, in lengths of the trunk.
inline double trunk_side(const TreePlan& plan) {
  return 1.1 * (0.08 + 0.25 * static_cast<double>(plan.trunk_curvature));
}

// The largest distance of a ring's vertex from a crooked branch, over the branch's radius at its
// base.
inline double ring_reach(double max_bend) {
  return 1.15 * (1 + 2 * max_bend * max_bend);  // above sqrt(1 + (2 bend)²)
}

}  // namespace psygen::models
