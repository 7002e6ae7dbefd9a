// The actions of the game, their usual keys, and what they mean in a step.
#pragma once

#include <array>
#include <string>

#include "engine/input/actions.hpp"
#include "engine/platform/window.hpp"
#include "game/play/walker.hpp"

namespace cairns {

enum class Act : std::size_t {
  kLookX,
  kLookY,
  kTurnX,
  kTurnY,
  kAhead,  // from here on they can be given other keys
  kBack,
  kLeft,
  kRight,
  kRun,
  kJump,
  kUse,
  kBuild,
  kFire,
  kSleep,
  kLantern,
  kEye,
  kMap,
  kPhoto,
  kMenu,
  kPicture,
  kCount
};
inline constexpr std::size_t kActs = static_cast<std::size_t>(Act::kCount);

// Adds all of them, in this order, to actions without any. Fails as input::Actions::add().
core::Result<void> add_actions(input::Actions& actions);
inline const input::ActionState& state_of(const input::Actions& actions, Act act) {
  return actions.state(static_cast<input::ActionId>(act));
}
// What the player wants in a step of `dt` seconds. `mouse`: how fast the view turns.
Intent intent_of(const input::Actions& actions, double mouse, double dt);
// What is printed on the key of an action, or the pad's button where that is used: "E". `window`
// may be null.
std::string key_of(const input::Actions& actions, Act act, const platform::Window* window);
// What an action does, for the settings.
const char* label_of(Act act);

}  // namespace cairns
