// Compares two worlds part by part, by hashes of everything that a part depends on. If two hashes
// are equal, results derived from that part of one world are valid for the other, to the bit.
// Values without edits; any thread. Sky, water and colours are not compared, because they are
// cheap.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

struct WorldParts {
  std::uint64_t ground = 0;  // heights, and the limits of placement
  // One hash for each scatter, in the world's order:
  std::vector<std::uint64_t> places;  // type name, placed instances, positions
  std::vector<std::uint64_t>
      models;  // the type and the parameters of its instances, on flat ground
  friend bool operator==(const WorldParts&, const WorldParts&) = default;
};

// `registry` must be that of the world.
WorldParts parts_of(const World& world, const models::Registry& registry);

}  // namespace psygen::world
