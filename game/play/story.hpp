// The story: a line and an ability for each cairn, in the order in which they are found.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>

#include "game/play/route.hpp"

namespace cairns {

// What a found cairn gives, in this order.
enum class Ability : std::uint8_t {
  kSail,     // glides
  kStride,   // runs faster
  kLantern,  // a light
  kSpring,   // jumps higher
  kRaft,     // crosses water fast and dry
  kGrip,     // climbs longer
  kWing,     // glides farther
  kAxe,      // fells faster
  kEye,      // sees far, and how far
  kSatchel,  // carries more stones
  kEmber,    // lights fires without wood
  kWind      // rises while it glides
};
using Abilities = std::bitset<kCairns>;
inline bool has(const Abilities& abilities, Ability ability) {
  return abilities[static_cast<std::size_t>(ability)];
}

struct Chapter {
  const char* gift;  // the name of the ability
  const char* line;  // of the story
  const char* help;  // how the ability is used
};

inline constexpr std::array<Chapter, kCairns> kChapters{{
    {"the sail", "She left the valley with a sheet of linen and no plan.",
     "In the air, hold jump to glide."},
    {"the long stride", "For nine days she did not look back. On the tenth she ran.",
     "You run faster."},
    {"the lantern", "Someone had kept a light here, long after anyone came.",
     "The lantern key lights your way."},
    {"the spring", "Goats taught her where the rock would hold.", "You jump higher."},
    {"the raft", "The lake remembered every face that had crossed it.",
     "Water carries you quickly."},
    {"the grip", "She wrote her name on the cliff in chalk. Rain read it.",
     "Hold jump at a steep face to climb; you climb longer now."},
    {"the wide wing", "From the ridge the land was one slow breath.", "You glide farther."},
    {"the axe", "One winter, one hut, one hundred trees. She planted two hundred.",
     "Trees fall faster."},
    {"the far eye", "She learned to tell smoke from cloud by how it wanted to be found.",
     "The look key brings far things near, and tells how far the next cairn is."},
    {"the satchel", "Every stone she carried was heavier than the one before, until it was not.",
     "You carry more stones."},
    {"the ember", "A fire can be carried in a horn for years, if someone breathes on it.",
     "You light fires without wood."},
    {"the wind", "There was no twelfth cairn. So she built it, and you have come.",
     "Jump while you glide, and the wind lifts you. The land is yours."},
}};

}  // namespace cairns
