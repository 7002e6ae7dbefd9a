#include "engine/models/network/settings.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

#include "engine/core/hash.hpp"

namespace psygen::models {
namespace {

struct Range {
  const char* name;
  double value, least, greatest;
};

}  // namespace

core::Result<void> check(const RiverSettings& s, const RiverFrame& frame) {
  const std::array ranges{
      Range{"root_spacing_m", s.root_spacing_m, 256, 65536},
      Range{"halvings", static_cast<double>(s.halvings), 1, 8},
      Range{"channel_km2", s.channel_km2, 1e-4, 1000},
      Range{"lake_share", s.lake_share, 0, 0.12},
      Range{"mountain_share", s.mountain_share, 0, 1},
      Range{"sea_share", s.sea_share, 0, 1},
      Range{"steepness", s.steepness, 0.05, 3},
      Range{"cell_m", frame.cell_m, 1e-3, 1e4},
      Range{"cells_per_block", static_cast<double>(frame.cells_per_block), 1, 4096},
      Range{"relief_m", frame.relief_m, 1, 1e5},
  };
  for (const Range& r : ranges) {
    if (!(r.value >= r.least && r.value <= r.greatest))
      return core::invalid_argument(fmt::format("rivers: {} is {}, but must lie in {} … {}", r.name,
                                                r.value, r.least, r.greatest));
  }
  if (!(frame.sea_level_m > 0 && frame.sea_level_m < frame.relief_m))
    return core::invalid_argument(
        fmt::format("rivers: the water level is {} m, but must lie above 0 and below {} m, the "
                    "height range of the ground",
                    frame.sea_level_m, frame.relief_m));
  const double finest = std::ldexp(s.root_spacing_m / frame.cell_m, -s.halvings);
  if (!(finest >= 16 && finest <= 512))
    return core::invalid_argument(
        fmt::format("rivers: root_spacing_m and halvings put the finest nodes {:.3g} cells apart, "
                    "but must put them 16 … 512 cells apart",
                    finest));
  return {};
}

std::uint64_t identity(const RiverSettings& s, const RiverFrame& frame) {
  std::uint64_t hash = core::combine(core::mix64(RiverSettings::kEdition), s.seed);
  for (const double value :
       {s.root_spacing_m, static_cast<double>(s.halvings), s.channel_km2, s.lake_share,
        s.mountain_share, s.sea_share, s.steepness, frame.cell_m,
        static_cast<double>(frame.cells_per_block), frame.relief_m, frame.sea_level_m})
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(value));
  return hash == 0 ? 1 : hash;
}

}  // namespace psygen::models
