// Networks and places that several tests of river networks ask.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/models/network/network.hpp"

namespace psygen::models::river_tests {

inline const RiverFrame kFrame{
    .cell_m = 1, .cells_per_block = 63, .relief_m = 2000, .sea_level_m = 200};

inline std::shared_ptr<const RiverNetwork> network_of(const RiverSettings& settings,
                                                      const RiverFrame& frame = kFrame) {
  return *RiverNetwork::create(settings, frame, std::make_shared<NetworkStore>());
}

// Places with land, water and much of both.
using Place = std::array<std::int64_t, 2>;
inline std::vector<Place> places(std::size_t count, std::int64_t far) {
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kPosition);
  std::vector<Place> result;
  while (result.size() < count)
    result.push_back({random.next_integer(-far, far), random.next_integer(-far, far)});
  return result;
}

inline core::WorldPosition position_of(double x, double z) {
  const double size = static_cast<double>(kFrame.cells_per_block);
  return core::normalised({{0, 0}, {x, 0, z}}, size);
}

}  // namespace psygen::models::river_tests
