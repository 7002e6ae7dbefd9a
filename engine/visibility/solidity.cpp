#include "engine/visibility/solidity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {

// Mean over heights h in [0, band] of the fraction of the ground that is higher than h.
float ground_share(float relief_m, float band_m) {
  if (relief_m <= 0) return 0;
  return band_m <= relief_m ? 1 - band_m / (2 * relief_m) : relief_m / (2 * band_m);
}

float standing_share(const Standing& kind, float side_m, float band_m) {
  const float met = std::numbers::pi_v<float> / 4 * kind.count * kind.width_m / side_m;
  return (1 - std::exp(-met * std::min(kind.density, 1.0F))) *
         std::min(kind.height_m / band_m, 1.0F);
}

}  // namespace

float estimate_solidity(float side_m, float relief_m, std::span<const Standing> standing,
                        float band_m) {
  PSYGEN_ASSERT(side_m > 0 && band_m > 0, "side and band must be positive");
  float passes = 1 - ground_share(relief_m, band_m);
  for (const Standing& kind : standing)
    passes *= 1 - standing_share(kind, side_m, band_m);
  return std::clamp(1 - passes, 0.0F, 1.0F);
}

}  // namespace psygen::visibility
