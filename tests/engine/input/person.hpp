// Frames of input that a test makes up: the actions of a person at keyboard, mouse and gamepad.
#pragma once

#include "engine/platform/input.hpp"

namespace psygen::input {

class Person {
 public:
  void press(platform::Key key) { set(state_.held, state_.went_down, key, true); }
  void release(platform::Key key) { set(state_.held, state_.went_up, key, false); }
  void press(platform::MouseButton button) {
    set(state_.buttons_held, state_.buttons_went_down, button, true);
  }
  void tap(platform::Key key) {
    press(key);
    release(key);
  }
  void roll(double steps) { state_.wheel += steps; }
  void move(double x, double y) { state_.move_px += glm::dvec2(x, y); }
  // With the gamepad of a slot, which is plugged in.
  void set_axis(platform::PadAxis axis, float value, std::size_t slot = 0) {
    plugged_in(slot).axes[static_cast<std::size_t>(axis)] = value;
  }
  void set_button(platform::PadButton button, bool down, std::size_t slot = 0) {
    plugged_in(slot).buttons.set(static_cast<std::size_t>(button), down);
  }
  void unplug(std::size_t slot = 0) { pad_[slot].reset(); }

  // The events since the last frame.
  platform::InputState frame() {
    platform::update_gamepads([this](std::size_t slot) { return pad_[slot]; }, state_.pads);
    platform::InputState result = state_;
    platform::clear_changes(state_);
    return result;
  }

 private:
  template <class Set, class Code>
  static void set(Set& held, Set& changed, Code code, bool down) {
    held.set(static_cast<std::size_t>(code), down);
    changed.set(static_cast<std::size_t>(code));
  }

  platform::PadReading& plugged_in(std::size_t slot) {
    return pad_[slot] ? *pad_[slot] : pad_[slot].emplace();
  }

  platform::InputState state_;
  std::array<std::optional<platform::PadReading>, platform::kGamepads> pad_;
};

}  // namespace psygen::input
