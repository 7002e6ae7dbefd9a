// Walks along a straight line over a plane of squares, with the parameters of each crossed square.
// Plain values and one template; linear in the squares (Amanatides and Woo, "A fast voxel traversal
// algorithm", Eurographics 1987).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>

namespace psygen::query {

// The points from + t · step. The absolute value of a component of `step` is 0 or at least
// kMinStep, so products with `inverse` are finite.
struct PlaneLine {
  static constexpr double kMinStep = 1e-15;
  glm::dvec2 from{0.0}, step{0.0}, inverse{0.0};

  // `direction` may have any length; components below kMinStep become 0.
  PlaneLine(glm::dvec2 first, glm::dvec2 direction) : from(first), step(direction) {
    for (int i = 0; i < 2; ++i) {
      if (std::abs(step[i]) < kMinStep) step[i] = 0;
      inverse[i] = step[i] == 0 ? 0 : 1 / step[i];
    }
  }
  // The point at parameter `t`.
  glm::dvec2 at(double t) const { return from + t * step; }
  // The parameter at which coordinate `axis` leaves the square `index` of this side length;
  // infinite if the line does not move along the axis.
  double leaves(int axis, std::int64_t index, double side) const {
    if (step[axis] == 0) return std::numeric_limits<double>::infinity();
    const auto border = static_cast<double>(step[axis] > 0 ? index + 1 : index) * side;
    return (border - from[axis]) * inverse[axis];
  }
};

// Calls visit(x, z, from, to) for each square [x · side, (x + 1) · side) × … that `line` crosses
// for t in [from, to], in order. Successive intervals touch; some may be empty. Ends when `visit`
// returns false. Rounding may start the walk in a neighbour of the first square.
template <class Visit>
void march(const PlaneLine& line, double side, double from, double to, Visit&& visit) {
  const glm::dvec2 first = line.at(from) / side;
  auto x = static_cast<std::int64_t>(std::floor(first.x));
  auto z = static_cast<std::int64_t>(std::floor(first.y));
  while (true) {
    const double leaves_x = line.leaves(0, x, side), leaves_z = line.leaves(1, z, side);
    const double until = std::clamp(std::min(leaves_x, leaves_z), from, std::max(from, to));
    if (!visit(x, z, from, until) || until >= to) return;
    from = until;
    if (leaves_x <= leaves_z)
      x += line.step.x > 0 ? 1 : -1;
    else
      z += line.step.y > 0 ? 1 : -1;
  }
}

}  // namespace psygen::query
