// A natural cubic spline through points in time: value, velocity and acceleration are continuous.
// Evaluation takes O(log points). Immutable; any thread.
#pragma once

#include <span>
#include <vector>

namespace psygen::world {

class Spline {
 public:
  Spline() = default;
  // At least one point; times grow strictly. One point makes a constant.
  Spline(std::span<const double> times, std::span<const double> values);

  // Before the first and after the last point the value of that point is held.
  double value(double time) const;
  // Per unit of time; 0 before the first and after the last point.
  double slope(double time) const;

 private:
  std::size_t segment_of(double time) const;

  std::vector<double> times_, values_;
  std::vector<double> bends_;  // second derivatives at the points
};

}  // namespace psygen::world
