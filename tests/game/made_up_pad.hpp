// A gamepad that a test presses: GLFW reports it, so that a game in its window is played by pad on
// machines without one. Main thread.
#pragma once

#include "engine/platform/keys.hpp"

namespace psygen {

// Connected while it lives. One at a time.
class MadeUpPad {
 public:
  MadeUpPad();
  ~MadeUpPad();
  MadeUpPad(const MadeUpPad&) = delete;
  MadeUpPad& operator=(const MadeUpPad&) = delete;

  void hold(platform::PadButton button, bool held);
  void move(platform::PadAxis axis, float to);
};

}  // namespace psygen
