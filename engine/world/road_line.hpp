// The centre line of a road as short straight segments: a natural cubic spline through its points
// with smoothed ground heights. The same bits on every machine. Any thread.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "engine/world/shaped_ground.hpp"

namespace psygen::world {

// A point of the centre line.
struct RoadPoint {
  glm::dvec2 at_m{0.0};  // x and z in the world
  double along_m = 0;    // distance from the start of the road
  double height_m = 0;
  std::size_t after = 0;  // index of the last control point up to here
};

// The total length of the straight lines between a road's points.
double chords_m(const Road& road);

// The points of the centre line, about `step_m` apart. `height_at` returns the height of the
// ground. Heights are weighted means of the ground up to road.smoothing_m before and behind a
// point, and over less at the ends, where the road meets the ground. Linear in points times
// smoothing over step.
std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at);

}  // namespace psygen::world
