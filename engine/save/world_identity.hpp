// Which world a save belongs to: its name, and a hash of what decides where things stand. Not the
// world itself; a game keeps that in its own files. Plain values; any thread.
#pragma once

#include <cstdint>
#include <string>

#include "engine/world/world.hpp"

namespace psygen::save {

// Two worlds with equal identities have the same ground and the same models in the same places.
struct WorldIdentity {
  std::string name;
  std::uint64_t hash = 0;
  friend bool operator==(const WorldIdentity&, const WorldIdentity&) = default;
};

// The identity of a world. The hash covers all parameters but sky and palette, which only change
// colours. Renaming a world changes its name and not its hash. O(size of the world file).
WorldIdentity identity_of(const world::World& world, const models::Registry& registry);

}  // namespace psygen::save
