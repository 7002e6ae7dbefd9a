// The start of a game and the places of its twelve cairns, a pure function of the land and its
// seed, with the story: a line and an ability for each cairn, in the order of discovery. Each cairn
// stands about 300 m from the previous one, on dry ground that the player can reach, and on high
// ground, so that it is visible.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>

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

// Abilities, in the order in which cairns give them.
enum class Ability : std::uint8_t {
  kSail,     // glide
  kStride,   // run faster
  kLantern,  // a light
  kSpring,   // jump higher
  kRaft,     // cross water fast and dry
  kGrip,     // climb longer
  kWing,     // glide farther
  kAxe,      // fell trees faster
  kEye,      // zoom in, and read distances
  kSatchel,  // carry more stones
  kEmber,    // light fires without wood
  kWind      // rise while gliding
};
using Abilities = std::bitset<kCairns>;
inline bool has(const Abilities& abilities, Ability ability) {
  return abilities[static_cast<std::size_t>(ability)];
}

struct Chapter {
  const char* gift;  // name of the ability
  const char* line;  // line of the story
  const char* help;  // instructions for the ability
};

inline constexpr std::array<Chapter, kCairns> kChapters{{
    {"the sail", "She left the valley with a sheet of linen and no plan.",
     "In the air, hold jump to glide."},
    {"the long stride", "For nine days she did not look back. On the tenth she ran.",
     "You run faster."},
    {"the lantern", "Someone had kept a light here, long after anyone came.",
     "Use the lantern key to light your way."},
    {"the spring", "Goats taught her where the rock would hold.", "You jump higher."},
    {"the raft", "The lake remembered every face that had crossed it.", "You cross water faster."},
    {"the grip", "She wrote her name on the cliff in chalk. Rain read it.",
     "Hold jump at a steep face to climb; you climb longer now."},
    {"the wide wing", "From the ridge the land was one slow breath.", "You glide farther."},
    {"the axe", "One winter, one hut, one hundred trees. She planted two hundred.",
     "Trees fall faster."},
    {"the far eye", "She learned to tell smoke from cloud by how it wanted to be found.",
     "Hold the spyglass key to zoom in and see the distance to the next cairn."},
    {"the satchel", "Every stone she carried was heavier than the one before, until it was not.",
     "You carry more stones."},
    {"the ember", "A fire can be carried in a horn for years, if someone breathes on it.",
     "You light fires without wood."},
    {"the wind", "There was no twelfth cairn. So she built it, and you have come.",
     "Jump while you glide, and the wind lifts you. The land is yours."},
}};

}  // namespace cairns
