// The position of the sun, and the colours of the sky for it.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "engine/world/atmosphere.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

constexpr double kDeclinationDeg = 12;  // of the sun, as in spring
constexpr float kMaxChange = 32;        // largest factor, needed for files with a very low sun

// Scales `colour`, which is correct for daylight `then`, to daylight `now`.
glm::vec3 changed(glm::vec3 colour, glm::vec3 then, glm::vec3 now) {
  const glm::vec3 dark(1e-6F);
  return colour * glm::min((now + dark) / (then + dark), glm::vec3(kMaxChange));
}

}  // namespace

glm::vec3 SunPlace::direction() const {
  const double azimuth = glm::radians(azimuth_deg), elevation = glm::radians(elevation_deg);
  return {static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
          static_cast<float>(std::sin(elevation)),
          static_cast<float>(-std::cos(azimuth) * std::cos(elevation))};
}

SunPlace Sky::sun_at(double time_s) const {
  if (day_length_s <= 0) return {sun_azimuth_deg, sun_elevation_deg};
  const double hour = start_hour + 24 * (time_s / day_length_s);
  const double turn = (hour - 12) / 12 * std::numbers::pi;  // 0 at noon, growing westwards
  const double latitude = glm::radians(latitude_deg), declination = glm::radians(kDeclinationDeg);
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(turn);
  const double west = std::cos(declination) * std::sin(turn);
  const double south = std::sin(latitude) * std::cos(declination) * std::cos(turn) -
                       std::cos(latitude) * std::sin(declination);
  const double azimuth = glm::degrees(std::atan2(-west, -south));
  return {azimuth < 0 ? azimuth + 360 : azimuth,
          glm::degrees(std::asin(std::clamp(up, -1.0, 1.0)))};
}

Sky with_sun(const Sky& sky, SunPlace sun) {
  Sky out = sky;
  out.sun_azimuth_deg = sun.azimuth_deg;
  out.sun_elevation_deg = sun.elevation_deg;
  if (sun.elevation_deg == sky.sun_elevation_deg) return out;
  const Daylight then = daylight(sky.sun_elevation_deg), now = daylight(sun.elevation_deg);
  out.sun_colour = changed(sky.sun_colour, then.sun, now.sun);
  out.zenith_colour = changed(sky.zenith_colour, then.zenith, now.zenith);
  out.horizon_colour = changed(sky.horizon_colour, then.horizon, now.horizon);
  out.ground_colour = changed(sky.ground_colour, then.ground, now.ground);
  out.haze_colour = changed(sky.haze_colour, then.haze, now.haze);
  return out;
}

}  // namespace psygen::world
