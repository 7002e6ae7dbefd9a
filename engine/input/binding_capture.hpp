// "Press a key ...": waits for the next control that the user presses, for a new binding. Ignores
// mouse movement, because the mouse always moves. Plain value, one thread; linear in controls.
#pragma once

#include <optional>
#include <vector>

#include "engine/input/control.hpp"

namespace psygen::input {

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
