#include "game/play/streams.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cairns {

std::optional<Stream> loudest_stream(query::World& query, const core::WorldPosition& listener) {
  constexpr double kHalfAwayM = 8, kAudible = 0.02;
  if (!query.world().shaped.has_water() && !query.world().edits) return std::nullopt;
  std::optional<Stream> loudest;
  const auto look = [&](double away_m, double angle) {
    core::WorldPosition at = listener;
    at.local.x += away_m * std::cos(angle);
    at.local.z += away_m * std::sin(angle);
    const auto water = query.water(at);
    if (!water || water->is_dry()) return;
    const double speed = std::hypot(double{water->flow_m_s.x}, double{water->flow_m_s.y});
    const double height_m = std::abs(listener.local.y - water->surface_m);
    const double near = 1 + (away_m * away_m + height_m * height_m) / (kHalfAwayM * kHalfAwayM);
    const double loud = speed * water->depth_m * (1 + 6 * double{water->foam}) / near;
    const double gain = std::min(0.5 * std::sqrt(loud), 1.0);
    if (gain < kAudible || (loudest && gain <= loudest->gain)) return;
    at = core::normalised(at, query.world().block_size_m());
    at.local.y = water->surface_m;
    loudest = Stream{at, gain};
  };
  look(0, 0);
  for (const double away_m : {3.0, 8.0, 16.0, 32.0}) {
    for (int i = 0; i < 8; ++i)
      look(away_m, (i + away_m / 64) * std::numbers::pi / 4);
  }
  return loudest;
}

}  // namespace cairns
