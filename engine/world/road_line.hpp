// The middle of a road as short straight segments: a natural cubic spline through its points, with
// heights that follow the ground calmly. The same bits on every machine. Any thread.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "engine/world/shaped_ground.hpp"

namespace psygen::world {

// A point of the middle.
struct RoadPoint {
  glm::dvec2 at_m{0.0};  // x and z in the world
  double along_m = 0;    // from the road's begin
  double height_m = 0;
  std::size_t after = 0;  // the last of the road's own points up to here
};

// The length of the straight lines between a road's points.
double chords_m(const Road& road);

// The points of the middle, about `step_m` apart. `height_at` is the ground. The heights are its
// mean over road.smoothing_m before and behind each point, less at the ends, where the road meets
// the ground. Linear in points times smoothing over step.
std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at);

}  // namespace psygen::world
