// The weather of a land, a pure function of its seed and the time.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace cairns {

struct Weather {
  double clouds = 0.4;   // 0 (clear) to 1 (overcast)
  double wet = 0;        // 0 (dry) to 1 (pouring); snow where it is cold
  double fog = 0;        // 0 (clear) to 1 (visibility of 150 m)
  glm::dvec3 wind{0.0};  // m/s
};

// Returns the weather at a time of the game in seconds. Changes take minutes.
Weather weather_at(std::uint64_t seed, double time_s);
// Height in metres above which rain becomes snow.
inline constexpr double kSnowLineM = 150;

}  // namespace cairns
