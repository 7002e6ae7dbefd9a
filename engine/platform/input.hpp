// Keyboard and mouse input since the last frame. A plain value that the window fills in and tests
// make up. Knows no window system.
#pragma once

#include <bitset>
#include <cstdint>
#include <glm/vec2.hpp>

namespace psygen::platform {

// Keys by their place on a US keyboard: WASD is the same block of keys on every layout. Left and
// right shift, control and alt are one key each.
// clang-format off
enum class Key : std::uint8_t {
  kA, kB, kC, kD, kE, kF, kG, kH, kI, kJ, kK, kL, kM, kN, kO, kP, kQ, kR, kS, kT, kU, kV, kW, kX,
  kY, kZ,
  k0, k1, k2, k3, k4, k5, k6, k7, k8, k9,
  kF1, kF2, kF3, kF4, kF5, kF6, kF7, kF8, kF9, kF10, kF11, kF12,
  kUp, kDown, kLeft, kRight, kPageUp, kPageDown, kHome, kEnd,
  kShift, kControl, kAlt, kSpace, kTab, kEnter, kEscape, kBackspace,
  kCount
};
// clang-format on
using KeySet = std::bitset<static_cast<std::size_t>(Key::kCount)>;  // one bit per key

// The input of one frame.
struct InputState {
  KeySet held;       // down at the end of the frame
  KeySet went_down;  // pressed during the frame, even if released again; not repeated while held
  glm::dvec2 look_px{0.0};  // mouse movement while looking: right, down; pixels
  double wheel = 0;         // steps; positive is away from the user
  bool looking = false;     // the right button is down
  bool resized = false;     // the framebuffer changed its size; ask the window for it

  // Whether the key is down at the end of the frame, or was pressed during it.
  bool is_held(Key key) const { return held[static_cast<std::size_t>(key)]; }
  bool was_pressed(Key key) const { return went_down[static_cast<std::size_t>(key)]; }
};

}  // namespace psygen::platform
