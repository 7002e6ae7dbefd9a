#include "engine/models/network/curve.hpp"

#include <cmath>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::models::network {
namespace {

// Height of the water of a curve without its least height.
float bent_m(const Curve& c, float t) {
  const float o = 1 - t;
  return o * o * c.height_m[0] + 2 * o * t * c.height_m[1] + t * t * c.height_m[2];
}

}  // namespace

float level_m(const Curve& c, float t) {
  return std::max(bent_m(c, t), c.min_m);
}

NearestPlace nearest_place(const Curve& c, float x_m, float z_m) {
  float best = 1e30F, t = 0;
  for (std::size_t k = 0; k < c.chords; ++k) {
    const float ex = c.px[k + 1] - c.px[k], ez = c.pz[k + 1] - c.pz[k];
    const float dx = x_m - c.px[k], dz = z_m - c.pz[k];
    const float f = std::clamp((dx * ex + dz * ez) * c.inverse_length2[k], 0.0F, 1.0F);
    const float qx = dx - f * ex, qz = dz - f * ez, square = qx * qx + qz * qz;
    if (square >= best) continue;
    best = square;
    t = (static_cast<float>(k) + f) / Curve::kChords;
  }
  return {std::sqrt(best), t};
}

float channel_width_m(double km2, double max_m) {
  return static_cast<float>(std::min(max_m, 2.6 * exact_pow(std::max(km2, 1e-9), 0.42)));
}

void lower_end(Curve& c, std::size_t chords, float to_m) {
  const float t = static_cast<float>(chords) / Curve::kChords;
  if (chords == 0) {
    c.height_m = {to_m, to_m, to_m};
  } else {
    c.height_m[2] -= std::max(bent_m(c, t) - to_m, 0.0F) / (t * t);
  }
}

}  // namespace psygen::models::network
