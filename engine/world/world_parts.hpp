// What two worlds have in common, part by part: hashes of everything that a part depends on. Where
// they are equal, what was derived of that part of one world is that of the other, to the bit.
// Values without edits; any thread. It compares no looks: sky, water and colours are cheap.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

struct WorldParts {
  std::uint64_t ground = 0;  // heights, and what decides where models may stand
  // Of each scatter, in the world's order:
  std::vector<std::uint64_t> places;  // its type by name, which instances find a place, and where
  std::vector<std::uint64_t>
      models;  // the type and the parameters of its instances, on flat ground
  friend bool operator==(const WorldParts&, const WorldParts&) = default;
};

// `registry` must be that of the world.
WorldParts parts_of(const World& world, const models::Registry& registry);

}  // namespace psygen::world
