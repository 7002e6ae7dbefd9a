#include "engine/world/atmosphere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using glm::dvec3;

// Kilometres. Coefficients at sea level for red, green and blue, 1/km.
constexpr double kEarth = 6360, kTop = 60;
constexpr double kAirHeight = 8.0, kDustHeight = 1.2;
constexpr dvec3 kAir{0.0058, 0.0135, 0.0331};
constexpr double kDust = 0.004, kDustExtinction = 0.0044, kDustForward = 0.76;
constexpr dvec3 kOzoneDepth{0.0098, 0.0282, 0.0013};  // straight up through all of it
constexpr double kCloudHeight = 2.0;
constexpr int kSteps = 24;
// Light scattered more than once, relative to single scattering.
constexpr double kMoreScattering = 0.5;
// Stars and airglow, relative to the radiance of a clear day. Then the exponent of adaptation: the
// fraction of a change in brightness (in logarithms) that the eye compensates.
constexpr double kNight = 2e-4;
constexpr double kAdaptation = 0.36;
// Light that the sky scatters again is equally bright but much bluer. Below: its fraction in the
// directions away from the sun.
constexpr dvec3 kSkyBlue{0.72, 1.0, 1.55};
constexpr double kZenithFill = 0.55, kHorizonFill = 0.6, kHazeFill = 0.7;
constexpr dvec3 kLuminance{0.2126, 0.7152, 0.0722};

// Optical depth along a ray, relative to the depth straight up from its start (Chapman's function
// for an exponential atmosphere, Schüler's approximation). `x`: distance from the centre of the
// Earth over the scale height. `cosine`: of the angle between the ray and the vertical.
double air_mass(double x, double cosine) {
  const double c = std::sqrt(std::numbers::pi / 2 * x);
  const double up = c / ((c - 1) * std::abs(cosine) + 1);
  if (cosine >= 0) return up;
  const double lowest = x * std::sqrt(1 - cosine * cosine);
  return 2 * std::sqrt(std::numbers::pi / 2 * lowest) * std::exp(std::min(x - lowest, 30.0)) - up;
}

// Fraction of light that reaches height `h` in km. `cosine`: of the angle between the light and the
// vertical.
dvec3 transmittance(double h, double cosine) {
  const double r = kEarth + h;
  const double air = std::exp(-h / kAirHeight) * kAirHeight * air_mass(r / kAirHeight, cosine);
  const double dust = std::exp(-h / kDustHeight) * kDustHeight * air_mass(r / kDustHeight, cosine);
  const double ozone = air_mass((kEarth + 25) / 6.0, std::max(cosine, 0.08));
  const dvec3 depth = kAir * air + kDustExtinction * dust + kOzoneDepth * ozone;
  // The Earth hides the sun gradually, over about half a degree.
  const double edge = -std::sqrt(std::max(0.0, 1 - kEarth * kEarth / (r * r)));
  return glm::exp(-glm::min(depth, dvec3(60.0))) *
         glm::smoothstep(edge - 0.006, edge + 0.006, cosine);
}

double air_phase(double cosine) {
  return 3 / (16 * std::numbers::pi) * (1 + cosine * cosine);
}
double dust_phase(double cosine) {
  const double g = kDustForward, d = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d));
}

// Radiance of the sky in direction `d` with the sun in direction `sun`. Both are unit vectors, +Y
// is up.
dvec3 sky(dvec3 d, dvec3 sun) {
  const double cosine = glm::dot(d, sun);
  const double air = air_phase(cosine) + kMoreScattering / (4 * std::numbers::pi);
  const double dust = dust_phase(cosine) + 0.3 * kMoreScattering / (4 * std::numbers::pi);
  const double b = kEarth * d.y;
  const double length = -b + std::sqrt(b * b + kTop * (2 * kEarth + kTop));
  dvec3 light(0.0), depth(0.0);
  double before = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 1.0) / kSteps, at = length * t * t * t;
    const double middle = 0.5 * (before + at), step = at - before;
    before = at;
    const dvec3 p = dvec3(0, kEarth, 0) + d * middle;
    const double r = glm::length(p), h = r - kEarth;
    const double air_here = std::exp(-h / kAirHeight), dust_here = std::exp(-h / kDustHeight);
    const dvec3 extinction = kAir * air_here + kDustExtinction * dust_here;
    const dvec3 scattered = kAir * (air_here * air) + kDust * dust_here * dust;
    light += scattered * glm::exp(-depth - 0.5 * step * extinction) * step *
             transmittance(h, glm::dot(p, sun) / r);
    depth += step * extinction;
  }
  return light;
}

dvec3 direction(double elevation, double azimuth) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

constexpr double kDeclinationDeg = 12;  // of the sun, as in spring
constexpr float kMaxChange = 32;        // largest factor, needed for files with a very low sun

// Scales `colour`, which is correct for daylight `then`, to daylight `now`.
glm::vec3 changed(glm::vec3 colour, glm::vec3 then, glm::vec3 now) {
  const glm::vec3 dark(1e-6F);
  return colour * glm::min((now + dark) / (then + dark), glm::vec3(kMaxChange));
}

}  // namespace

Daylight daylight(double sun_elevation_deg) {
  const double elevation = glm::radians(std::clamp(sun_elevation_deg, -90.0, 90.0));
  const dvec3 sun = direction(elevation, 0);
  const double aside = std::numbers::pi / 2;
  const double near_sun = std::max(elevation, glm::radians(2.0)) + glm::radians(6.0);
  const dvec3 night = kNight * dvec3(0.55, 0.75, 1.3);
  const auto aside_of = [&](dvec3 d, double fill) {
    const dvec3 once = sky(d, sun) + night;
    return glm::mix(once, glm::dot(once, kLuminance) * kSkyBlue, fill);
  };
  const dvec3 zenith = aside_of({0, 1, 0}, kZenithFill);
  const dvec3 horizon = aside_of(direction(glm::radians(14.0), aside), kHorizonFill);
  const dvec3 haze = aside_of(direction(glm::radians(4.0), aside), kHazeFill);
  const dvec3 glow =
      glm::max(sky(direction(near_sun, 0), sun) - sky(direction(near_sun, aside), sun), dvec3(0.0));
  const dvec3 direct = transmittance(0, sun.y);
  // Light from below: the ground reflects sun and sky.
  const dvec3 ground = std::max(sun.y, 0.0) * direct + std::numbers::pi * 0.5 * (zenith + horizon);
  const double bright = std::pow(glm::dot(ground, kLuminance), -kAdaptation);
  const auto seen = [bright](dvec3 light) { return glm::vec3(light * bright); };
  return {.sun = seen(direct),
          .zenith = seen(zenith),
          .horizon = seen(horizon),
          .haze = seen(haze),
          .ground = seen(ground),
          .glow = seen(glow),
          .cloud = seen(transmittance(kCloudHeight, sun.y))};
}

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
