// A fake gamepad: GLFW reports it, so that tests play by gamepad on machines without one. Main
// thread only.
#pragma once

#include "engine/platform/keys.hpp"

namespace psygen {

// Connected during its lifetime. At most one at a time.
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
