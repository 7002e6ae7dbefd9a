// Curves of roads and rivers and shores of lakes as short straight segments. The same bits on every
// machine. Pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace psygen::world {

inline double length_of(glm::dvec2 v) {
  return std::sqrt(v.x * v.x + v.y * v.y);
}

// The place nearest to `at_m` on a straight segment, as a fraction of its length.
inline double nearest_share(glm::dvec2 from_m, glm::dvec2 to_m, glm::dvec2 at_m) {
  const glm::dvec2 along = to_m - from_m, to = at_m - from_m;
  const double length2 = along.x * along.x + along.y * along.y;
  return length2 > 0 ? std::clamp((to.x * along.x + to.y * along.y) / length2, 0.0, 1.0) : 0;
}

// An axis-aligned rectangle, empty at first.
struct FlatBox {
  glm::dvec2 low{1e300}, high{-1e300};
  static FlatBox around(glm::dvec2 a, glm::dvec2 b) {
    return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
  }
  void add(glm::dvec2 point) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
  bool touches(const FlatBox& o, double within_m = 0) const {
    return low.x - within_m <= o.high.x && o.low.x - within_m <= high.x &&
           low.y - within_m <= o.high.y && o.low.y - within_m <= high.y;
  }
  glm::dvec2 centre() const { return (low + high) * 0.5; }
  glm::dvec2 size() const { return high - low; }
};

// A point of a curve.
struct CurvePoint {
  glm::dvec2 at_m{0.0};
  double along_m = 0;     // distance from the start, along the segments
  std::size_t after = 0;  // index of the last control point up to here
  double share = 0;       // of the way to the next control point: 0 up to below 1
};

// The length of the straight lines from each point to the next.
double chords_m(std::span<const glm::dvec2> points);

// A natural cubic spline through at least two points; and one through at least three points that
// closes smoothly, whose last point is the one before the first. Points are about `step_m` apart.
std::vector<CurvePoint> curve_through(std::span<const glm::dvec2> points, double step_m);
std::vector<glm::dvec2> closed_curve_through(std::span<const glm::dvec2> points, double step_m);

// Returns a place where a line of straight segments crosses or touches itself; nothing: it does
// not. With `is_closed`, a segment leads from the last point to the first.
std::optional<glm::dvec2> self_crossing(std::span<const glm::dvec2> line, bool is_closed);

}  // namespace psygen::world
