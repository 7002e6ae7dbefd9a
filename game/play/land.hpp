// The land of a game: the world file of Cairns with the seed of the game in place of its own, and
// ways between places in it. Pure but for reading that file. Knows no rules.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace cairns {

using namespace psygen;

// The seed that a player's text stands for: its number if it is one, else a hash of the text.
std::uint64_t seed_of(std::string_view typed);

// Where the world file is: `worlds/cairns.toml` of the data folders. Fails with kIo.
core::Result<std::string> land_file();
// Its text with this seed. Fails with kIo, and with kParse where the file has no seed.
core::Result<std::string> land_text(std::uint64_t seed);
// Adds the model types of the game to those of the engine.
core::Result<void> add_types(models::Registry& registry);

// A land without a session: for tests, and for playing without pictures.
struct Land {
  models::Registry registry;
  world::World world;
  std::string text;  // of its file
  // Fails as land_text() and world::parse_world().
  static core::Result<std::unique_ptr<Land>> load(std::uint64_t seed);
};

// The name of a cell of a grid over the land, by its numbers east and south.
constexpr std::uint64_t cell_name(std::int32_t x, std::int32_t z) {
  return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(z);
}

// The way from one place to another, in metres. Exact as core::offset_m().
glm::dvec3 way_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m);
// Its length in the plane.
double distance_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m);
// The place at the end of a way, normalised.
core::WorldPosition at_end_of(const core::WorldPosition& from, const glm::dvec3& way,
                              double block_m);

}  // namespace cairns
