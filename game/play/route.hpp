// The start of a game and the places of its twelve cairns, a pure function of the land and its
// seed. Each cairn stands about 300 m from the previous one, on dry ground that the player can
// reach, and on high ground, so that it is visible.
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

// Fails with kInvalidArgument if the land is all water or cliffs.
core::Result<Route> find_route(query::World& query);

}  // namespace cairns
