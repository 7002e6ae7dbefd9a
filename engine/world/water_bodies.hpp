// Rivers and lakes as a world file or a game describes them. Plain values. water_shapes.hpp makes
// ground and water of them. docs/world-files.md.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::world {

// A river along a natural cubic spline through its points, downstream. Lists have one number for
// the whole river, or one for each point, linear between points.
struct River {
  std::vector<glm::dvec2> points_m;  // x and z in the world; at least two
  std::vector<double> width_m{8};    // of the water
  std::vector<double> depth_m{1.5};  // in the middle
  // Empty: that of Manning's formula for width and depth with n = 0.035 and a fall of 1 m in 1 km.
  std::vector<double> discharge_m3_s;
  double bank_m = 6;        // on both sides: width of the slope up to the ground; more in deep cuts
  double smoothing_m = 20;  // steps of the surface are spread over this distance
  bool enabled = true;      // of a world file: else there is no river
  friend bool operator==(const River&, const River&) = default;
};

// A lake inside an outline, or inside a circle.
struct Lake {
  std::vector<glm::dvec2> points_m;  // of the outline, a closed spline; empty: a circle
  glm::dvec2 centre_m{0.0};          // of the circle: x and z in the world
  double radius_m = 0;
  std::optional<double> spill_m;  // height of the surface; none: the lowest ground of the outline
  double depth_m = 4;             // of the bed, from shore_m inside the outline on
  double shore_m = 8;             // width of the slopes on both sides of the outline
  bool enabled = true;            // of a world file: else there is no lake
  friend bool operator==(const Lake&, const Lake&) = default;
};

// Limits of a file. Points are at least kMinWaterStepM apart.
inline constexpr std::size_t kMaxRivers = 64, kMaxLakes = 64, kMaxWaterPoints = 1000;
inline constexpr double kMinWaterStepM = 1, kMaxRiversM = 100'000, kMaxLakeM = 4000;
inline constexpr double kMinDepthM = 0.1, kMaxRiverDepthM = 100, kMaxLakeDepthM = 500;
inline constexpr double kMinRiverM = 1;  // of width and bank
inline constexpr double kMaxRiverWidthM = 1000, kMaxRiverBankM = 200, kMaxSmoothingM = 1000;
inline constexpr double kMaxDischarge = 1e6, kMaxShoreM = 500;  // m³/s, m

}  // namespace psygen::world
