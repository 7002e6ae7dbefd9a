// A natural cubic spline through points in time, with continuous value, velocity and acceleration.
// Evaluation takes O(log points). Immutable, any thread. Does not extrapolate.
#pragma once

#include <span>
#include <vector>

namespace psygen::world {

// One value over time.
class Spline {
 public:
  // Empty; assign before use.
  Spline() = default;
  // At least one point, and as many values as times; times ascend strictly. One point makes a
  // constant. Linear in the points.
  Spline(std::span<const double> times, std::span<const double> values);

  // The value at a time. Before the first and after the last point it is the value of that point.
  double value(double time) const;
  // The derivative per unit of time; 0 before the first and after the last point.
  double slope(double time) const;

 private:
  std::size_t segment_of(double time) const;

  std::vector<double> times_, values_;
  std::vector<double> bends_;  // second derivatives at the points
};

}  // namespace psygen::world
