// The part of a frame that lacks detail: the metric missing.pixels (docs/cli.md). Pure.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/scene/draws/draw_lists.hpp"

namespace psygen::scene {

// Percentage of the frame that a ball around `centre` (metres from the camera) covers.
inline double covered_percent(const Camera& camera, glm::vec3 centre, float radius_m) {
  const double distance_m = std::max(glm::length(centre), radius_m);
  const double radius_px = camera.pixels_per_radian * radius_m / distance_m;
  const double picture = static_cast<double>(camera.size.width) * camera.size.height;
  return std::min(100.0, 100.0 * std::numbers::pi * radius_px * radius_px / picture);
}

// A node or model that the frame shows, or should show.
struct VisiblePiece {
  glm::vec3 centre{0.0F};  // metres from the camera
  float radius_m = 0;
  bool hole = false;    // drawn at no level
  bool coarse = false;  // drawn by more than one level too coarse
  bool twice = false;   // drawn with more than twice its allowed error
  bool awaits = true;   // a better mesh can still be synthesised
};

// Adds a piece to all counts.
inline void count_visible(const Camera& camera, const VisiblePiece& piece, DrawCounts& counts) {
  const double percent = covered_percent(camera, piece.centre, piece.radius_m);
  const bool lacks = piece.hole || piece.coarse;
  ++counts.nodes_in_view;
  if (piece.hole) ++counts.holes;
  if (piece.coarse) ++counts.coarse;
  if ((lacks || piece.twice) && piece.awaits) ++counts.awaited;
  if (lacks) counts.missing_pixels_percent += percent;
  counts.seen_area += percent;
  if (lacks || piece.twice) counts.too_coarse_area += percent;
}

}  // namespace psygen::scene
