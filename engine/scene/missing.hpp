// How much of the picture is missing: the measure behind missing.pixels (docs/cli.md). Pure.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Share of the picture, in percent, that a ball around `center` (metres from the camera) covers.
inline double covered_percent(const Camera& camera, glm::vec3 center, float radius_m) {
  const double distance_m = std::max(glm::length(center), radius_m);
  const double radius_px = camera.pixels_per_radian * radius_m / distance_m;
  const double picture = static_cast<double>(camera.size.width) * camera.size.height;
  return std::min(100.0, 100.0 * std::numbers::pi * radius_px * radius_px / picture);
}

// Something in the picture that is drawn at no level (`hole`), or by more than one too coarse;
// `failed`: some of its levels cannot be synthesised.
inline void count_seen(const Camera& camera, glm::vec3 center, float radius_m, bool hole,
                       bool coarse, bool failed, Counters& counters) {
  ++counters.nodes_in_view;
  if (hole) ++counters.holes;
  if (coarse) ++counters.coarse;
  if ((hole || coarse) && !failed) ++counters.awaited;
  if (hole || coarse) counters.missing_pixels_percent += covered_percent(camera, center, radius_m);
}

}  // namespace psygen::scene
