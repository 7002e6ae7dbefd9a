// Which world a save belongs to: its name, and a hash of what decides where things stand. Not the
// world itself; a game keeps that in its own files. Plain values; any thread.
#pragma once

#include <cstdint>
#include <string>

#include "engine/world/world.hpp"

namespace psygen::save {

// Two worlds with equal hashes have the same ground and the same models in the same places. The
// name is for people: messages, and lists of saves.
struct WorldIdentity {
  std::string name;
  std::uint64_t hash = 0;
  friend bool operator==(const WorldIdentity&, const WorldIdentity&) = default;
};

// The identity of a world. The hash covers seed, size, ground, what is scattered, the branches of
// species, and the height of the water. It does not cover names, sky, palette, other looks, and
// parameters with their usual values: saves stay valid when the engine gets a new parameter whose
// usual value changes nothing. O(size of the world file).
WorldIdentity identity_of(const world::World& world, const models::Registry& registry);

}  // namespace psygen::save
