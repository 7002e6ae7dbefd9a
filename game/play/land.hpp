// The land of a game: the world file of Cairns with the game's seed, and distances between
// positions, and the weather. Pure, except for reading the world file. It contains no rules of the
// game.
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

// Returns the seed for a player's text: its value if it is a number, else a hash of the text.
std::uint64_t seed_of(std::string_view typed);

// Returns the path of the world file, `worlds/cairns.toml` in the data folders. Fails with kIo.
core::Result<std::string> land_file();
// Returns the text of the world file with this seed. Fails with kIo, or with kParse if the file has
// no line for the seed.
core::Result<std::string> land_text(std::uint64_t seed);
// Adds the model types of the game to those of the engine.
core::Result<void> add_types(models::Registry& registry);

// A land without a session, for tests and for playing without a renderer.
struct Land {
  models::Registry registry;
  world::World world;
  std::string text;  // of the world file
  // Fails like land_text() and world::parse_world().
  static core::Result<std::unique_ptr<Land>> load(std::uint64_t seed);
};

// Returns the key of a grid cell, from its indices towards east and south.
constexpr std::uint64_t cell_name(std::int32_t x, std::int32_t z) {
  return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(z);
}

// Returns the offset between two positions in metres, as exact as core::offset_m().
glm::dvec3 way_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m);
// Returns the horizontal distance of two positions in metres.
double distance_m(const core::WorldPosition& from, const core::WorldPosition& to, double block_m);
// Returns the position at an offset in metres, normalised.
core::WorldPosition position_at_offset(const core::WorldPosition& from, const glm::dvec3& way,
                                       double block_m);

// The weather of a land, a pure function of its seed and the time.
struct Weather {
  double clouds = 0.4;   // 0 (clear) to 1 (overcast)
  double wet = 0;        // 0 (dry) to 1 (pouring); snow where it is cold
  double fog = 0;        // 0 (clear) to 1 (visibility of 150 m)
  glm::dvec3 wind{0.0};  // m/s
};

// Returns the weather at a time of the game in seconds. Changes take minutes.
Weather weather_at(std::uint64_t seed, double time_s);
// Height in metres above which rain becomes snow.
inline constexpr double kSnowLineM = 150;

}  // namespace cairns
