// How loud a sound is at a distance. Pure; any thread.
#pragma once

namespace psygen::audio {

// Metres. A sound has its full gain up to near_m, falls off as near_m / distance, and is silent
// from far_m on. 0 < near_m < far_m.
struct Range {
  double near_m = 2;
  double far_m = 200;
};

// The share of the gain that is left, 0 to 1: near / d · (far − d) / (far − near) between the two.
double attenuation(double distance_m, const Range& range);

}  // namespace psygen::audio
