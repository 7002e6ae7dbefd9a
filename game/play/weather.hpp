// The weather of a land: a function of its seed and the time. Pure.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace cairns {

struct Weather {
  double clouds = 0.4;   // 0 clear … 1 overcast
  double wet = 0;        // 0 dry … 1 pouring: rain, or snow where it is cold
  double fog = 0;        // 0 clear air … 1: one sees 150 m
  glm::dvec3 wind{0.0};  // m/s
};

// At a time of the game, in seconds. Changes slowly: minutes from fair to foul.
Weather weather_at(std::uint64_t seed, double time_s);
// Above this height it snows instead of raining, in metres.
inline constexpr double kSnowLineM = 150;

}  // namespace cairns
