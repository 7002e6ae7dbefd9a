#include "engine/world/spline.hpp"

#include <algorithm>

#include "engine/core/assert.hpp"

namespace psygen::world {

// The second derivatives solve a tridiagonal system by forward elimination and back substitution.
Spline::Spline(std::span<const double> times, std::span<const double> values)
    : times_(times.begin(), times.end()),
      values_(values.begin(), values.end()),
      bends_(times.size(), 0.0) {
  PSYGEN_ASSERT(!times.empty() && times.size() == values.size(),
                "every point needs a time and a value");
  const std::size_t n = times_.size();
  std::vector<double> factors(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = times_[i] - times_[i - 1], after = times_[i + 1] - times_[i];
    const double change =
        (values_[i + 1] - values_[i]) / after - (values_[i] - values_[i - 1]) / before;
    const double pivot = 2 * (before + after) - before * factors[i - 1];
    factors[i] = after / pivot;
    bends_[i] = (6 * change - before * bends_[i - 1]) / pivot;
  }
  for (std::size_t i = n; i-- > 1;)
    bends_[i - 1] -= factors[i - 1] * bends_[i];
}

std::size_t Spline::segment_of(double time) const {
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  return static_cast<std::size_t>(next - times_.begin()) - 1;
}

double Spline::value(double time) const {
  if (!(time > times_.front())) return values_.front();
  if (time >= times_.back()) return values_.back();
  const std::size_t i = segment_of(time);
  const double h = times_[i + 1] - times_[i];
  const double b = (time - times_[i]) / h, a = 1 - b;
  return a * values_[i] + b * values_[i + 1] +
         ((a * a * a - a) * bends_[i] + (b * b * b - b) * bends_[i + 1]) * h * h / 6;
}

double Spline::slope(double time) const {
  if (times_.size() < 2 || !(time >= times_.front()) || time > times_.back()) return 0;
  const std::size_t i = segment_of(time);
  const double h = times_[i + 1] - times_[i];
  const double b = (time - times_[i]) / h, a = 1 - b;
  return (values_[i + 1] - values_[i]) / h +
         ((3 * b * b - 1) * bends_[i + 1] - (3 * a * a - 1) * bends_[i]) * h / 6;
}

}  // namespace psygen::world
