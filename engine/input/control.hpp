// Everything that a user can move: a key, a mouse button, the wheel, the mouse itself, a button or
// half an axis of a gamepad. Each has a name and a value of 0 or more, so an axis is two controls,
// and a game gives them signs. Plain values, any thread. Knows no actions (actions.hpp).
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/platform/input.hpp"

namespace psygen::input {

// The enum of `code`: Key, MouseButton, WheelDirection, MouseDirection, PadButton,
// PadAxisDirection.
enum class Device : std::uint8_t { kKey, kMouseButton, kWheel, kMouse, kPadButton, kPadAxis };

// True for controls of a gamepad.
constexpr bool is_of_pad(Device device) {
  return device == Device::kPadButton || device == Device::kPadAxis;
}

// Directions of the wheel and the mouse, and half axes of gamepads.
enum class WheelDirection : std::uint8_t { kUp, kDown, kLeft, kRight, kCount };
enum class MouseDirection : std::uint8_t { kUp, kDown, kLeft, kRight, kCount };
enum class PadAxisDirection : std::uint8_t {
  kLeftStickUp,
  kLeftStickDown,
  kLeftStickLeft,
  kLeftStickRight,
  kRightStickUp,
  kRightStickDown,
  kRightStickLeft,
  kRightStickRight,
  kLeftTrigger,
  kRightTrigger,
  kCount
};

// One control, identified by its device and a code of that device.
struct Control {
  Device device = Device::kKey;
  std::uint8_t code = 0;

  Control() = default;
  // A key, button, or half of an axis by its enumerator.
  Control(platform::Key key) : code(static_cast<std::uint8_t>(key)) {}
  Control(platform::MouseButton button)
      : device(Device::kMouseButton), code(static_cast<std::uint8_t>(button)) {}
  Control(WheelDirection way) : device(Device::kWheel), code(static_cast<std::uint8_t>(way)) {}
  Control(MouseDirection way) : device(Device::kMouse), code(static_cast<std::uint8_t>(way)) {}
  Control(platform::PadButton button)
      : device(Device::kPadButton), code(static_cast<std::uint8_t>(button)) {}
  Control(PadAxisDirection way) : device(Device::kPadAxis), code(static_cast<std::uint8_t>(way)) {}

  friend bool operator==(const Control&, const Control&) = default;
};

// Every control, keys first.
std::span<const Control> all_controls();

// "W", "Mouse Left", "Wheel Up", "Mouse Move Left", "Gamepad A", "Gamepad Left Stick Up".
std::string_view name_of(Control control);
// The control with a name; fails with kInvalidArgument and the nearest name. Linear in the
// controls.
core::Result<Control> control_named(std::string_view name);

// True for controls that move by an amount since the last frame (wheel, mouse) instead of being
// held.
bool is_relative(Control control);
// True for controls that are held or not, without values in between.
bool is_digital(Control control);

// The state of a control in a frame.
struct Reading {
  double value = 0;  // digital: 0 or 1; axes: 0 … 1; wheel: steps; mouse: screen coordinates
  bool went_down = false;  // digital only; pressed during the frame
  bool went_up = false;
  double length = 0;  // axes: how far the stick is pushed in any direction, at least `value`
};
// For a gamepad control: the strongest value of all gamepads, or the value of one slot. Never NaN,
// at most 1e6.
Reading read(Control control, const platform::InputState& input,
             std::optional<std::size_t> pad_slot = {});

// "Press a key ...": waits for the next control that the user presses, for a new binding. Ignores
// mouse movement, because the mouse always moves. One thread; linear in controls.
class BindingCapture {
 public:
  // Starts at `now`. Controls held then must be released before they count.
  explicit BindingCapture(const platform::InputState& now);
  // The control pressed in this frame, or nothing. Call it once per frame. Modifier keys are
  // reported as left or right. The caller chooses the key that cancels.
  std::optional<Control> update(const platform::InputState& input);

 private:
  std::vector<bool> armed_;  // for each of all_controls(): it has been at rest
};

}  // namespace psygen::input
