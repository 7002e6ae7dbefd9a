// Gamepads as values: held buttons, and changes since the last poll. The caller provides the
// readings (the window asks GLFW, tests make them up). Gamepads can be connected and disconnected
// at run time; having none is no error. Knows no mappings of devices. Main thread.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "engine/platform/keys.hpp"

namespace psygen::platform {

inline constexpr std::size_t kGamepads =
    16;  // slots; a gamepad keeps its slot while it is connected

// One slot. Everything is 0 and false without a gamepad.
struct Gamepad {
  bool connected = false;
  bool came = false, went = false;        // connected or disconnected since the last poll
  PadButtonSet held, went_down, went_up;  // as in InputState
  std::array<float, kPadAxes> axes{};     // without a dead zone; see PadAxis

  // The state of one button or axis; false and 0 without a gamepad.
  bool is_held(PadButton button) const { return held[static_cast<std::size_t>(button)]; }
  float axis(PadAxis which) const { return axes[static_cast<std::size_t>(which)]; }
};
using Gamepads = std::array<Gamepad, kGamepads>;

// The current state reported by a device.
struct PadReading {
  PadButtonSet buttons;
  std::array<float, kPadAxes> axes{};
};
// Returns the reading of a slot, 0 … kGamepads − 1, or nothing if it has no gamepad.
using ReadPad = std::function<std::optional<PadReading>(std::size_t slot)>;

// Adds new readings to `pads`. Changes accumulate until clear_changes(). Axes are clamped to their
// range; values that are not finite count as 0. Buttons of a disconnected gamepad are released.
void update_gamepads(const ReadPad& read, Gamepads& pads);
// Clears came, went, went_down and went_up.
void clear_changes(Gamepads& pads);

}  // namespace psygen::platform
