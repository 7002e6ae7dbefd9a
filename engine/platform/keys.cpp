#include "engine/platform/keys.hpp"

#include <array>

namespace psygen::platform {
namespace {

using namespace std::string_view_literals;

// clang-format off
constexpr std::array kKeyNames{
  "A"sv, "B"sv, "C"sv, "D"sv, "E"sv, "F"sv, "G"sv, "H"sv, "I"sv, "J"sv, "K"sv, "L"sv, "M"sv, "N"sv,
  "O"sv, "P"sv, "Q"sv, "R"sv, "S"sv, "T"sv, "U"sv, "V"sv, "W"sv, "X"sv, "Y"sv, "Z"sv,
  "0"sv, "1"sv, "2"sv, "3"sv, "4"sv, "5"sv, "6"sv, "7"sv, "8"sv, "9"sv,
  "F1"sv, "F2"sv, "F3"sv, "F4"sv, "F5"sv, "F6"sv, "F7"sv, "F8"sv, "F9"sv, "F10"sv, "F11"sv, "F12"sv,
  "F13"sv, "F14"sv, "F15"sv, "F16"sv, "F17"sv, "F18"sv, "F19"sv, "F20"sv, "F21"sv, "F22"sv, "F23"sv,
  "F24"sv, "F25"sv,
  "Keypad 0"sv, "Keypad 1"sv, "Keypad 2"sv, "Keypad 3"sv, "Keypad 4"sv, "Keypad 5"sv, "Keypad 6"sv,
  "Keypad 7"sv, "Keypad 8"sv, "Keypad 9"sv, "Keypad Decimal"sv, "Keypad Divide"sv,
  "Keypad Multiply"sv, "Keypad Subtract"sv, "Keypad Add"sv, "Keypad Enter"sv, "Keypad Equal"sv,
  "Up"sv, "Down"sv, "Left"sv, "Right"sv, "Page Up"sv, "Page Down"sv, "Home"sv, "End"sv, "Insert"sv,
  "Delete"sv,
  "Shift"sv, "Control"sv, "Alt"sv,
  "Left Shift"sv, "Right Shift"sv, "Left Control"sv, "Right Control"sv, "Left Alt"sv,
  "Right Alt"sv, "Left Super"sv, "Right Super"sv, "Menu"sv,
  "Space"sv, "Tab"sv, "Enter"sv, "Escape"sv, "Backspace"sv,
  "Apostrophe"sv, "Comma"sv, "Minus"sv, "Period"sv, "Slash"sv, "Semicolon"sv, "Equal"sv,
  "Left Bracket"sv, "Backslash"sv, "Right Bracket"sv, "Grave"sv, "World 1"sv, "World 2"sv,
  "Caps Lock"sv, "Scroll Lock"sv, "Num Lock"sv, "Print Screen"sv, "Pause"sv,
};
constexpr std::array kMouseButtonNames{
  "Mouse Left"sv, "Mouse Right"sv, "Mouse Middle"sv, "Mouse 4"sv, "Mouse 5"sv, "Mouse 6"sv,
  "Mouse 7"sv, "Mouse 8"sv,
};
constexpr std::array kPadButtonNames{
  "Gamepad A"sv, "Gamepad B"sv, "Gamepad X"sv, "Gamepad Y"sv, "Gamepad Left Bumper"sv,
  "Gamepad Right Bumper"sv, "Gamepad Back"sv, "Gamepad Start"sv, "Gamepad Guide"sv,
  "Gamepad Left Thumb"sv, "Gamepad Right Thumb"sv, "Gamepad Up"sv, "Gamepad Right"sv,
  "Gamepad Down"sv, "Gamepad Left"sv,
};
// clang-format on
static_assert(kKeyNames.size() == kKeys);
static_assert(kMouseButtonNames.size() == kMouseButtons);
static_assert(kPadButtonNames.size() == kPadButtons);

}  // namespace

std::string_view name_of(Key key) {
  return kKeyNames[static_cast<std::size_t>(key)];
}
std::string_view name_of(MouseButton button) {
  return kMouseButtonNames[static_cast<std::size_t>(button)];
}
std::string_view name_of(PadButton button) {
  return kPadButtonNames[static_cast<std::size_t>(button)];
}

}  // namespace psygen::platform
