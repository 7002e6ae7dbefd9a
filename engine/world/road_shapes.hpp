// Makes the edits of the ground that roads are: pieces of a centre line at the smoothed height of
// the ground below. The same bits on every machine. Pure functions; the world and its layers stay
// as they are. Internal to world.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/shaped_ground.hpp"

namespace psygen::world {

// A point of the centre line of a road.
struct RoadPoint {
  glm::dvec2 at_m{0.0};  // x and z in the world
  double along_m = 0;    // distance from the start of the road
  double height_m = 0;
};

// The centre line of a road: points of curve_through(), about `step_m` apart, with smoothed ground
// heights. `height_at` returns the height of the ground. Heights are weighted means of the ground
// up to road.smoothing_m before and behind a point, and over less at the ends, where the road meets
// the ground. Linear in points times smoothing over step.
std::vector<RoadPoint> road_line(const Road& road, double step_m,
                                 const std::function<double(glm::dvec2)>& height_at);

// The edits of a road over the ground of `below`, without ids and not sealed. Requires points
// inside the world. Linear in length times width. Fails with kOverBudget where more than 1,000
// segments of the road are close together, and with kInterrupted if the work is cancelled.
core::Result<std::vector<models::GroundEdit>> road_edits(const World& world,
                                                         const models::EditLayer& below,
                                                         const Road& road);

}  // namespace psygen::world
