#include "game/play/weather.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/hash.hpp"

namespace cairns {
namespace {

// Value noise with one knot per integer, 0 to 1.
double noise(std::uint64_t seed, double at) {
  const double knot = std::floor(at);
  const auto value = [&](double k) {
    const std::uint64_t number = static_cast<std::uint64_t>(static_cast<std::int64_t>(k));
    return static_cast<double>(psygen::core::combine(seed, number) >> 11) * 0x1.0p-53;
  };
  const double t = at - knot, s = t * t * (3 - 2 * t);
  return std::lerp(value(knot), value(knot + 1), s);
}

// Linear ramp: 0 up to `from`, 1 from `to` on.
double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

}  // namespace

Weather weather_at(std::uint64_t seed, double time_s) {
  // Every game starts in fair weather.
  const double calm = ramp(time_s, 120, 420);
  const double foul = calm * noise(seed ^ 1, time_s / 260);
  Weather now;
  now.clouds = std::lerp(0.2 + 0.25 * noise(seed ^ 2, time_s / 180), 1.0, ramp(foul, 0.45, 0.75));
  now.wet = ramp(foul, 0.66, 0.9);
  now.fog = std::max(0.45 * now.wet, calm * ramp(noise(seed ^ 3, time_s / 330), 0.72, 0.95));
  const double speed = 1.5 + 7 * foul, from = 6.28 * noise(seed ^ 4, time_s / 700);
  now.wind = {speed * std::cos(from), 0, speed * std::sin(from)};
  return now;
}

}  // namespace cairns
