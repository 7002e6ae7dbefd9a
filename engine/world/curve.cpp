#include "engine/world/curve.hpp"

#include <algorithm>
#include <cmath>

#include "engine/world/spline.hpp"

namespace psygen::world {
namespace {

// The splines of both coordinates over the lengths of the chords.
struct PlaneSpline {
  std::vector<double> chords{0};
  Spline east, south;

  explicit PlaneSpline(std::span<const glm::dvec2> points) {
    std::vector<double> x{points.front().x}, z{points.front().y};
    for (std::size_t i = 1; i < points.size(); ++i) {
      chords.push_back(chords.back() + length_of(points[i] - points[i - 1]));
      x.push_back(points[i].x);
      z.push_back(points[i].y);
    }
    east = Spline(chords, x);
    south = Spline(chords, z);
  }
  glm::dvec2 at(double chord) const { return {east.value(chord), south.value(chord)}; }

  // Calls visit(place, share) for places from behind point i to point i + 1, which has the share 1.
  template <class Visit>
  void walk(std::size_t i, double step_m, const Visit& visit) const {
    const double chord_m = chords[i + 1] - chords[i];
    const auto steps = std::max(1, static_cast<int>(std::ceil(chord_m / step_m)));
    for (int k = 1; k < steps; ++k)
      visit(at(chords[i] + chord_m * k / steps), static_cast<double>(k) / steps);
    visit(at(chords[i + 1]), 1.0);
  }
};

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

bool meet(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
  const double of_c = cross(b - a, c - a), of_d = cross(b - a, d - a);
  const double of_a = cross(d - c, a - c), of_b = cross(d - c, b - c);
  const auto opposite = [](double p, double q) { return (p <= 0 && q >= 0) || (p >= 0 && q <= 0); };
  if (!opposite(of_c, of_d) || !opposite(of_a, of_b)) return false;
  // Matters for segments of one straight line.
  return FlatBox::around(a, b).touches(FlatBox::around(c, d));
}

}  // namespace

double chords_m(std::span<const glm::dvec2> points) {
  double length_m = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    length_m += length_of(points[i] - points[i - 1]);
  return length_m;
}

std::vector<CurvePoint> curve_through(std::span<const glm::dvec2> points, double step_m) {
  const PlaneSpline spline(points);
  std::vector<CurvePoint> curve{{points.front(), 0, 0, 0}};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    spline.walk(i, step_m, [&](glm::dvec2 at_m, double share) {
      const double along_m = curve.back().along_m + length_of(at_m - curve.back().at_m);
      if (share < 1)
        curve.push_back({at_m, along_m, i, share});
      else
        curve.push_back({at_m, along_m, i + 1, 0});
    });
  }
  return curve;
}

std::vector<glm::dvec2> closed_curve_through(std::span<const glm::dvec2> points, double step_m) {
  // A natural spline forgets its ends within some points, so a few turns more close it smoothly.
  const std::size_t n = points.size(), more = std::max<std::size_t>(n, 8);
  std::vector<glm::dvec2> turns;
  for (std::size_t i = 0; i < n + 2 * more + 1; ++i)
    turns.push_back(points[(i + n * more - more) % n]);
  const PlaneSpline spline(turns);
  std::vector<glm::dvec2> curve;
  for (std::size_t i = more; i < more + n; ++i)
    spline.walk(i, step_m, [&](glm::dvec2 at_m, double) { curve.push_back(at_m); });
  return curve;
}

std::optional<glm::dvec2> self_crossing(std::span<const glm::dvec2> line, bool is_closed) {
  constexpr std::size_t kGroup = 16;
  const std::size_t count = is_closed ? line.size() : line.size() - 1;
  const auto end_of = [&](std::size_t i) { return line[(i + 1) % line.size()]; };
  std::vector<FlatBox> boxes((count + kGroup - 1) / kGroup);
  for (std::size_t i = 0; i < count; ++i)
    boxes[i / kGroup].add(line[i]), boxes[i / kGroup].add(end_of(i));
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    for (std::size_t q = p; q < boxes.size(); ++q) {
      if (!boxes[p].touches(boxes[q])) continue;
      for (std::size_t i = p * kGroup; i < std::min((p + 1) * kGroup, count); ++i) {
        for (std::size_t k = std::max(q * kGroup, i + 2); k < std::min((q + 1) * kGroup, count);
             ++k) {
          if (is_closed && i == 0 && k + 1 == count) continue;  // neighbours
          if (meet(line[i], end_of(i), line[k], end_of(k))) return line[k];
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace psygen::world
