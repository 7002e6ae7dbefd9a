#include "engine/world/road_line.hpp"

#include <algorithm>
#include <cmath>

#include "engine/world/spline.hpp"

namespace psygen::world {
namespace {

double apart_m(glm::dvec2 a, glm::dvec2 b) {
  const double x = b.x - a.x, z = b.y - a.y;
  return std::sqrt(x * x + z * z);
}

// Lengths of the straight lines from the first point to each.
std::vector<double> chords_to(const Road& road) {
  std::vector<double> chords{0};
  for (std::size_t i = 1; i < road.points_m.size(); ++i)
    chords.push_back(chords.back() + apart_m(road.points_m[i - 1], road.points_m[i]));
  return chords;
}

// Averages the heights, weighted by a tent over `smoothing_m` on both sides, or less at the ends.
void smooth(std::vector<RoadPoint>& line, double smoothing_m) {
  std::vector<double> means;
  const double end_m = line.back().along_m;
  std::size_t first = 0;
  for (const RoadPoint& point : line) {
    const double wide_m = std::min({smoothing_m, point.along_m, end_m - point.along_m});
    while (first > 0 && line[first - 1].along_m > point.along_m - wide_m)
      --first;
    while (line[first].along_m < point.along_m - wide_m)
      ++first;
    double sum = 0, weights = 0;
    for (std::size_t i = first; i < line.size() && line[i].along_m <= point.along_m + wide_m; ++i) {
      const double away = std::abs(line[i].along_m - point.along_m);
      const double weight = wide_m > 0 ? 1 - away / wide_m : 1;
      sum += weight * line[i].height_m;
      weights += weight;
    }
    means.push_back(weights > 0 ? sum / weights : point.height_m);
  }
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i].height_m = means[i];
}

}  // namespace

double chords_m(const Road& road) {
  return chords_to(road).back();
}

std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at) {
  const std::vector<double> chords = chords_to(road);
  std::vector<double> x, z;
  for (const glm::dvec2& point : road.points_m) {
    x.push_back(point.x);
    z.push_back(point.y);
  }
  const Spline east(chords, x), south(chords, z);
  std::vector<RoadPoint> line{{road.points_m.front(), 0, 0}};
  for (std::size_t i = 1; i < chords.size(); ++i) {
    const double chord_m = chords[i] - chords[i - 1];
    const auto steps = static_cast<int>(std::ceil(chord_m / step_m));
    for (int k = 1; k <= steps; ++k) {
      const double at = k < steps ? chords[i - 1] + chord_m * k / steps : chords[i];
      const glm::dvec2 place_m{east.value(at), south.value(at)};
      const double along_m = line.back().along_m + apart_m(line.back().at_m, place_m);
      line.push_back({place_m, along_m, 0, k < steps ? i - 1 : i});
    }
  }
  for (RoadPoint& point : line)
    point.height_m = height_at(point.at_m);
  // Two passes with a tent make a smooth bell.
  smooth(line, road.smoothing_m / 2);
  smooth(line, road.smoothing_m / 2);
  return line;
}

}  // namespace psygen::world
