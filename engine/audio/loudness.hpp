// The loudness of a sound at a distance. Pure; any thread.
#pragma once

namespace psygen::audio {

// Metres. A sound has its full gain up to near_m, falls off as near_m / distance, and is silent
// from far_m on. 0 < near_m < far_m.
struct Range {
  double near_m = 2;
  double far_m = 200;
};

// The remaining fraction of the gain, 0 to 1: near / d · (far − d) / (far − near) between the two.
double attenuation(double distance_m, const Range& range);

}  // namespace psygen::audio
