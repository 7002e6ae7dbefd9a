// The world of a save: its name, and a hash of everything that decides positions. The world itself
// is not stored; a game keeps it in its own files. Plain values; any thread.
#pragma once

#include <cstdint>
#include <string>

#include "engine/world/world.hpp"

namespace psygen::save {

// Two worlds with equal hashes have the same ground and the same models at the same positions. The
// name is for people: messages, and lists of saves.
struct WorldIdentity {
  std::string name;
  std::uint64_t hash = 0;
  friend bool operator==(const WorldIdentity&, const WorldIdentity&) = default;
};

// The identity of a world. The hash covers seed, size, ground, scattered models, the branches of
// species, and the water level. It does not cover names, sky, palette, other appearance, and
// parameters with their default values: saves stay valid when the engine gets a new parameter whose
// default changes nothing. O(size of the world file).
WorldIdentity identity_of(const world::World& world, const models::Registry& registry);

}  // namespace psygen::save
