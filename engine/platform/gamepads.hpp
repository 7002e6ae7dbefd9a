// Gamepads as values: what is held, and what changed since the last poll. Where readings come from
// is the caller's (the window asks GLFW, tests make them up). Gamepads come and go at run time;
// none is no error. Knows no mapping of devices. Main thread.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "engine/platform/keys.hpp"

namespace psygen::platform {

inline constexpr std::size_t kGamepads = 16;  // slots; a gamepad keeps its slot while it is there

// One slot. Everything is 0 and false without a gamepad.
struct Gamepad {
  bool connected = false;
  bool came = false, went = false;        // connected or disconnected since the last poll
  PadButtonSet held, went_down, went_up;  // as InputState's
  std::array<float, kPadAxes> axes{};     // without a dead zone; see PadAxis

  // The state of one button or axis; false and 0 without a gamepad.
  bool is_held(PadButton button) const { return held[static_cast<std::size_t>(button)]; }
  float axis(PadAxis which) const { return axes[static_cast<std::size_t>(which)]; }
};
using Gamepads = std::array<Gamepad, kGamepads>;

// What a device reports now.
struct PadReading {
  PadButtonSet buttons;
  std::array<float, kPadAxes> axes{};
};
// The reading of a slot, 0 … kGamepads − 1; nothing where there is no gamepad.
using ReadPad = std::function<std::optional<PadReading>(std::size_t slot)>;

// Adds new readings to `pads`. Changes add up until clear_changes(). Axes are clamped to their
// range, and those that are not finite count as 0. What a lost gamepad held goes up.
void update_gamepads(const ReadPad& read, Gamepads& pads);
// Forgets came, went, went_down and went_up.
void clear_changes(Gamepads& pads);

}  // namespace psygen::platform
