// Keys, mouse buttons, and the buttons and axes of gamepads, with their names for binding files and
// menus. Window::label_of() gives the label on a key's cap. Plain values, any thread.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace psygen::platform {

// Keys by their position on a US keyboard: WASD is the same block of keys on every layout. kShift,
// kControl and kAlt are down if the left or the right one is.
// clang-format off
enum class Key : std::uint8_t {
  kA, kB, kC, kD, kE, kF, kG, kH, kI, kJ, kK, kL, kM, kN, kO, kP, kQ, kR, kS, kT, kU, kV, kW, kX,
  kY, kZ,
  k0, k1, k2, k3, k4, k5, k6, k7, k8, k9,
  kF1, kF2, kF3, kF4, kF5, kF6, kF7, kF8, kF9, kF10, kF11, kF12, kF13, kF14, kF15, kF16, kF17,
  kF18, kF19, kF20, kF21, kF22, kF23, kF24, kF25,
  kKeypad0, kKeypad1, kKeypad2, kKeypad3, kKeypad4, kKeypad5, kKeypad6, kKeypad7, kKeypad8,
  kKeypad9, kKeypadDecimal, kKeypadDivide, kKeypadMultiply, kKeypadSubtract, kKeypadAdd,
  kKeypadEnter, kKeypadEqual,
  kUp, kDown, kLeft, kRight, kPageUp, kPageDown, kHome, kEnd, kInsert, kDelete,
  kShift, kControl, kAlt,
  kLeftShift, kRightShift, kLeftControl, kRightControl, kLeftAlt, kRightAlt, kLeftSuper,
  kRightSuper, kMenu,
  kSpace, kTab, kEnter, kEscape, kBackspace,
  kApostrophe, kComma, kMinus, kPeriod, kSlash, kSemicolon, kEqual, kLeftBracket, kBackslash,
  kRightBracket, kGrave, kWorld1, kWorld2,
  kCapsLock, kScrollLock, kNumLock, kPrintScreen, kPause,
  kCount
};
enum class MouseButton : std::uint8_t { kLeft, kRight, kMiddle, k4, k5, k6, k7, k8, kCount };
// Buttons by their position on a gamepad with the layout of an Xbox controller.
enum class PadButton : std::uint8_t {
  kA, kB, kX, kY, kLeftBumper, kRightBumper, kBack, kStart, kGuide, kLeftThumb, kRightThumb,
  kUp, kRight, kDown, kLeft, kCount
};
// clang-format on
// Sticks are −1 … 1, right and up are positive. Triggers are 0 … 1.
enum class PadAxis : std::uint8_t {
  kLeftX,
  kLeftY,
  kRightX,
  kRightY,
  kLeftTrigger,
  kRightTrigger,
  kCount
};

inline constexpr std::size_t kKeys = static_cast<std::size_t>(Key::kCount);
inline constexpr std::size_t kMouseButtons = static_cast<std::size_t>(MouseButton::kCount);
inline constexpr std::size_t kPadButtons = static_cast<std::size_t>(PadButton::kCount);
inline constexpr std::size_t kPadAxes = static_cast<std::size_t>(PadAxis::kCount);
using KeySet = std::bitset<kKeys>;  // one bit per key
using MouseButtonSet = std::bitset<kMouseButtons>;
using PadButtonSet = std::bitset<kPadButtons>;

// "W", "Left Shift", "Keypad 7"; "Mouse Left", "Mouse 4"; "Gamepad A".
std::string_view name_of(Key key);
std::string_view name_of(MouseButton button);
std::string_view name_of(PadButton button);

}  // namespace psygen::platform
