#include "engine/app/gui_input.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>

namespace psygen::app {
namespace {

using platform::Key;
using platform::PadButton;

// ImGui takes events since 1.87, and names them as below since 1.89. Before, it reads arrays.
#if IMGUI_VERSION_NUM < 18900
#define PSYGEN_IMGUI_ARRAYS
using PadMeaning = decltype(ImGuiNavInput_Activate);
constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeyPadEnter;
constexpr std::pair<PadMeaning, PadButton> kPadButtons[] = {
    {ImGuiNavInput_Activate, PadButton::kA},
    {ImGuiNavInput_Cancel, PadButton::kB},
    {ImGuiNavInput_Menu, PadButton::kX},
    {ImGuiNavInput_Input, PadButton::kY},
    {ImGuiNavInput_DpadLeft, PadButton::kLeft},
    {ImGuiNavInput_DpadRight, PadButton::kRight},
    {ImGuiNavInput_DpadUp, PadButton::kUp},
    {ImGuiNavInput_DpadDown, PadButton::kDown},
    {ImGuiNavInput_FocusPrev, PadButton::kLeftBumper},
    {ImGuiNavInput_FocusNext, PadButton::kRightBumper}};
// Left, right, up, down.
constexpr PadMeaning kStick[] = {ImGuiNavInput_LStickLeft, ImGuiNavInput_LStickRight,
                                 ImGuiNavInput_LStickUp, ImGuiNavInput_LStickDown};
#else
using PadMeaning = ImGuiKey;
constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeypadEnter;
constexpr std::pair<PadMeaning, PadButton> kPadButtons[] = {
    {ImGuiKey_GamepadFaceDown, PadButton::kA},    {ImGuiKey_GamepadFaceRight, PadButton::kB},
    {ImGuiKey_GamepadFaceLeft, PadButton::kX},    {ImGuiKey_GamepadFaceUp, PadButton::kY},
    {ImGuiKey_GamepadDpadLeft, PadButton::kLeft}, {ImGuiKey_GamepadDpadRight, PadButton::kRight},
    {ImGuiKey_GamepadDpadUp, PadButton::kUp},     {ImGuiKey_GamepadDpadDown, PadButton::kDown},
    {ImGuiKey_GamepadL1, PadButton::kLeftBumper}, {ImGuiKey_GamepadR1, PadButton::kRightBumper}};
// Left, right, up, down.
constexpr PadMeaning kStick[] = {ImGuiKey_GamepadLStickLeft, ImGuiKey_GamepadLStickRight,
                                 ImGuiKey_GamepadLStickUp, ImGuiKey_GamepadLStickDown};
#endif

// Keys that ImGui uses by function. Letters serve shortcuts such as Ctrl+A.
constexpr std::pair<ImGuiKey, Key> kKeys[] = {{ImGuiKey_Tab, Key::kTab},
                                              {ImGuiKey_LeftArrow, Key::kLeft},
                                              {ImGuiKey_RightArrow, Key::kRight},
                                              {ImGuiKey_UpArrow, Key::kUp},
                                              {ImGuiKey_DownArrow, Key::kDown},
                                              {ImGuiKey_PageUp, Key::kPageUp},
                                              {ImGuiKey_PageDown, Key::kPageDown},
                                              {ImGuiKey_Home, Key::kHome},
                                              {ImGuiKey_End, Key::kEnd},
                                              {ImGuiKey_Insert, Key::kInsert},
                                              {ImGuiKey_Delete, Key::kDelete},
                                              {ImGuiKey_Backspace, Key::kBackspace},
                                              {ImGuiKey_Space, Key::kSpace},
                                              {ImGuiKey_Enter, Key::kEnter},
                                              {ImGuiKey_Escape, Key::kEscape},
                                              {kKeypadEnter, Key::kKeypadEnter},
                                              {ImGuiKey_A, Key::kA},
                                              {ImGuiKey_C, Key::kC},
                                              {ImGuiKey_V, Key::kV},
                                              {ImGuiKey_X, Key::kX},
                                              {ImGuiKey_Y, Key::kY},
                                              {ImGuiKey_Z, Key::kZ}};

// Also counts a key pressed and released within the frame.
template <class Set>
bool down(const Set& held, const Set& went_down, std::size_t bit) {
  return held[bit] || went_down[bit];
}

// A captured pointer has no position.
ImVec2 pointer_of(const platform::InputState& input) {
  const auto at = [](double px) {
    return static_cast<float>(std::isfinite(px) ? std::clamp(px, -1e6, 1e6) : -1.0);
  };
  return input.looking ? ImVec2(-1e30F, -1e30F)
                       : ImVec2(at(input.pointer_px.x), at(input.pointer_px.y));
}

bool super_is_held(const platform::InputState& input) {
  return input.is_held(Key::kLeftSuper) || input.is_held(Key::kRightSuper);
}

#ifdef PSYGEN_IMGUI_ARRAYS
void feed_mouse(const platform::InputState& input, ImGuiIO& io) {
  io.MousePos = pointer_of(input);
  // The order of ImGui's buttons equals ours: left, right, middle.
  for (std::size_t i = 0; i < std::size(io.MouseDown); ++i)
    io.MouseDown[i] = down(input.buttons_held, input.buttons_went_down, i);
  io.MouseWheel += static_cast<float>(input.wheel);
  io.MouseWheelH += static_cast<float>(input.wheel_x);
}

void feed_keys(const platform::InputState& input, ImGuiIO& io) {
  for (std::size_t i = 0; i < platform::kKeys; ++i)
    io.KeysDown[i] = down(input.held, input.went_down, i);
  io.KeyCtrl = input.is_held(Key::kControl);
  io.KeyShift = input.is_held(Key::kShift);
  io.KeyAlt = input.is_held(Key::kAlt);
  io.KeySuper = super_is_held(input);
}

void feed_tilt(PadMeaning meaning, float tilt, ImGuiIO& io) {
  io.NavInputs[meaning] = tilt;
}
#else
void feed_mouse(const platform::InputState& input, ImGuiIO& io) {
  const ImVec2 pointer = pointer_of(input);
  io.AddMousePosEvent(pointer.x, pointer.y);
  // The order of ImGui's buttons equals ours: left, right, middle.
  for (int i = 0; i < ImGuiMouseButton_COUNT; ++i) {
    const auto bit = static_cast<std::size_t>(i);
    io.AddMouseButtonEvent(i, down(input.buttons_held, input.buttons_went_down, bit));
  }
  io.AddMouseWheelEvent(static_cast<float>(input.wheel_x), static_cast<float>(input.wheel));
}

void feed_keys(const platform::InputState& input, ImGuiIO& io) {
  io.AddKeyEvent(ImGuiMod_Ctrl, input.is_held(Key::kControl));
  io.AddKeyEvent(ImGuiMod_Shift, input.is_held(Key::kShift));
  io.AddKeyEvent(ImGuiMod_Alt, input.is_held(Key::kAlt));
  io.AddKeyEvent(ImGuiMod_Super, super_is_held(input));
  for (const auto& [meaning, key] : kKeys)
    io.AddKeyEvent(meaning, down(input.held, input.went_down, static_cast<std::size_t>(key)));
}

void feed_tilt(PadMeaning meaning, float tilt, ImGuiIO& io) {
  io.AddKeyAnalogEvent(meaning, tilt > 0, tilt);
}
#endif

// For menus without a mouse, if the game sets ImGuiConfigFlags_NavEnableGamepad. ImGui has one
// gamepad: it gets the buttons of all, and the widest tilts.
void feed_gamepads(const platform::InputState& input, ImGuiIO& io) {
  constexpr float kRest = 0.15F;  // a stick rests up to this tilt
  std::array<bool, std::size(kPadButtons)> held{};
  std::array<float, std::size(kStick)> tilts{};
  io.BackendFlags &= ~ImGuiBackendFlags_HasGamepad;
  for (const platform::Gamepad& pad : input.pads) {
    if (!pad.connected) continue;
    io.BackendFlags |= ImGuiBackendFlags_HasGamepad;
    for (std::size_t i = 0; i < held.size(); ++i)
      held[i] |= pad.is_held(kPadButtons[i].second);
    const float x = pad.axis(platform::PadAxis::kLeftX), y = pad.axis(platform::PadAxis::kLeftY);
    const float sides[] = {-x, x, y, -y};
    for (std::size_t i = 0; i < tilts.size(); ++i)
      tilts[i] = std::max(tilts[i], sides[i] > kRest ? sides[i] : 0.0F);
  }
  for (std::size_t i = 0; i < held.size(); ++i)
    feed_tilt(kPadButtons[i].first, held[i] ? 1.0F : 0.0F, io);
  for (std::size_t i = 0; i < tilts.size(); ++i)
    feed_tilt(kStick[i], tilts[i], io);
}

}  // namespace

void prepare_input(ImGuiIO& io) {
#ifdef PSYGEN_IMGUI_ARRAYS
  static_assert(platform::kKeys <= std::extent_v<decltype(ImGuiIO::KeysDown)>);
  for (const auto& [meaning, key] : kKeys)
    io.KeyMap[meaning] = static_cast<int>(key);
#else
  io.ConfigInputTrickleEventQueue = false;  // one frame takes all events
#endif
}

void feed_input(const platform::InputState& input, ImGuiIO& io) {
  feed_mouse(input, io);
  feed_keys(input, io);
  io.AddInputCharactersUTF8(input.text.c_str());
  feed_gamepads(input, io);
}

}  // namespace psygen::app
