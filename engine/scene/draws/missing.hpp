// How much of the picture is missing: the measure behind missing.pixels (docs/cli.md). Pure.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Share of the picture, in percent, that a ball around `centre` (metres from the camera) covers.
inline double covered_percent(const Camera& camera, glm::vec3 centre, float radius_m) {
  const double distance_m = std::max(glm::length(centre), radius_m);
  const double radius_px = camera.pixels_per_radian * radius_m / distance_m;
  const double picture = static_cast<double>(camera.size.width) * camera.size.height;
  return std::min(100.0, 100.0 * std::numbers::pi * radius_px * radius_px / picture);
}

// Something that is in the picture, or should be.
struct SeenPiece {
  glm::vec3 centre{0.0F};  // metres from the camera
  float radius_m = 0;
  bool hole = false;    // drawn at no level
  bool coarse = false;  // … by more than one level too coarse
  bool twice = false;   // … with more than twice the error that it might have
  bool awaits = true;   // … until what is better has been synthesised
};

// Counts a piece in all figures of what is missing.
inline void count_seen(const Camera& camera, const SeenPiece& piece, Counters& counters) {
  const double percent = covered_percent(camera, piece.centre, piece.radius_m);
  const bool lacks = piece.hole || piece.coarse;
  ++counters.nodes_in_view;
  if (piece.hole) ++counters.holes;
  if (piece.coarse) ++counters.coarse;
  if ((lacks || piece.twice) && piece.awaits) ++counters.awaited;
  if (lacks) counters.missing_pixels_percent += percent;
  counters.seen_area += percent;
  if (lacks || piece.twice) counters.too_coarse_area += percent;
}

}  // namespace psygen::scene
