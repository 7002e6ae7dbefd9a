// Keyboard, mouse, text and gamepads since the last frame. A plain value that the window fills in
// and tests make up. Knows no window system. Actions of a game are in engine/input.
#pragma once

#include <array>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "engine/core/coordinates.hpp"
#include "engine/platform/keys.hpp"

namespace psygen::platform {

// Gamepads: held buttons, and changes since the last poll. The caller provides the readings (the
// window asks GLFW, tests make them up). Gamepads can be connected and disconnected at run time;
// having none is no error. Knows no mappings of devices.

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

// The input of one frame.
struct InputState {
  KeySet held;       // down at the end of the frame
  KeySet went_down;  // pressed during the frame, even if released again; not repeated while held
  KeySet went_up;    // released during the frame, even if pressed again
  KeySet repeated;   // repeated by the keyboard while held; for text fields
  MouseButtonSet buttons_held, buttons_went_down, buttons_went_up;
  std::string text;               // typed text, UTF-8; at most kMaxTextBytes
  glm::dvec2 pointer_px{0.0};     // in the image, from its upper left corner; while the cursor is
                                  // captured it means nothing
  glm::dvec2 move_px{0.0};        // mouse movement: right, down; screen coordinates
  glm::dvec2 look_px{0.0};        // the same while looking
  double wheel = 0, wheel_x = 0;  // steps; positive is away from the user, and to the left
  bool looking = false;           // the right button is down, or the cursor is captured
  bool captured = false;          // Window::capture_cursor()
  bool focused = true;            // the window has the keyboard
  bool resized = false;           // the framebuffer changed its size; ask the window for it
  Gamepads pads;

  static constexpr std::size_t kMaxTextBytes = 4096;

  // True if the key is down at the end of the frame; was pressed; was released during it.
  bool is_held(Key key) const { return held[static_cast<std::size_t>(key)]; }
  bool was_pressed(Key key) const { return went_down[static_cast<std::size_t>(key)]; }
  bool was_released(Key key) const { return went_up[static_cast<std::size_t>(key)]; }
  // The same for a mouse button.
  bool is_held(MouseButton button) const { return buttons_held[static_cast<std::size_t>(button)]; }
  bool was_pressed(MouseButton button) const {
    return buttons_went_down[static_cast<std::size_t>(button)];
  }
  bool was_released(MouseButton button) const {
    return buttons_went_up[static_cast<std::size_t>(button)];
  }
};

// Clears the events of a frame; held controls stay.
void clear_changes(InputState& input);

// The devices whose input another reader takes.
struct TakenDevices {
  bool keyboard = false, mouse = false;
};

// Removes input that another reader takes, such as a text field or a menu. One filter per reader.
class InputFilter {
 public:
  // `now` without keyboard and text, or without the mouse. Releases once what the last result held.
  // A control that was pressed while taken stays hidden until it is released. Gamepads are not
  // filtered.
  InputState apply(const InputState& now, TakenDevices taken);

 private:
  KeySet held_, taken_;
  MouseButtonSet buttons_held_, buttons_taken_;
};

}  // namespace psygen::platform
