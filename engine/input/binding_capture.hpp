// "Press a key ...": waits for the next control that a person presses, for a new binding. Movement
// of the mouse is not taken, because it always moves. Plain value, one thread; linear in controls.
#pragma once

#include <optional>
#include <vector>

#include "engine/input/control.hpp"

namespace psygen::input {

class BindingCapture {
 public:
  // Starts at `now`: what is held then must be released before it counts.
  explicit BindingCapture(const platform::InputState& now);
  // The control pressed in this frame; nothing if there was none. Once per frame. Keys are told as
  // the left or the right one. Which key cancels is the caller's choice.
  std::optional<Control> update(const platform::InputState& input);

 private:
  std::vector<bool> armed_;  // of all_controls(): it has been at rest
};

}  // namespace psygen::input
