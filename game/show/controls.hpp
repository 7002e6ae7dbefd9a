// The actions of the game, their default keys, and their effect on a step.
#pragma once

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
  kAhead,  // actions from here on can be rebound
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

// Adds all actions in this order to an empty set. Fails like input::Actions::add().
core::Result<void> add_actions(input::Actions& actions);
inline const input::ActionState& state_of(const input::Actions& actions, Act act) {
  return actions.state(static_cast<input::ActionId>(act));
}
// Returns the player's intent for a step of `dt` seconds. `mouse` is the mouse sensitivity.
Intent intent_of(const input::Actions& actions, double mouse, double dt);
// Returns the label of an action's key, or of its gamepad button while a gamepad is in use: "E".
// `window` may be null.
std::string key_of(const input::Actions& actions, Act act, const platform::Window* window);
// Returns the label of an action in the settings.
const char* label_of(Act act);

}  // namespace cairns
