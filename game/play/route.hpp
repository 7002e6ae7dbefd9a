// Where a game begins and where its twelve cairns stand: a function of the land and its seed. Each
// cairn is some 300 m from the one before, on dry ground that a walker can reach, and rather high,
// so that it is seen. Nothing is random but the seed.
#pragma once

#include <array>

#include "engine/query/world.hpp"
#include "game/play/land.hpp"

namespace cairns {

inline constexpr std::size_t kCairns = 12;

struct Route {
  core::WorldPosition start;                        // feet
  std::array<core::WorldPosition, kCairns> cairns;  // on the ground
};

// Fails with kInvalidArgument in a land that is all water or cliffs.
core::Result<Route> find_route(query::World& query);

}  // namespace cairns
