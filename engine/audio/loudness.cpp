#include "engine/audio/loudness.hpp"

namespace psygen::audio {

double attenuation(double distance_m, const Range& range) {
  if (distance_m <= range.near_m) return 1;
  if (!(distance_m < range.far_m)) return 0;
  return range.near_m / distance_m * (range.far_m - distance_m) / (range.far_m - range.near_m);
}

}  // namespace psygen::audio
