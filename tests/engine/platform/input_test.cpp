#include "engine/platform/input.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psygen::platform {
namespace {

constexpr auto kW = static_cast<std::size_t>(Key::kW);
constexpr auto kLeft = static_cast<std::size_t>(MouseButton::kLeft);

InputState frame(bool held, bool down = false, bool up = false) {
  InputState input;
  input.held.set(kW, held);
  input.went_down.set(kW, down);
  input.went_up.set(kW, up);
  return input;
}

TEST(InputState, ClearsEventsAndKeepsHeldControls) {
  InputState input = frame(true, true);
  input.text.push_back('a');
  input.wheel = 1;
  input.buttons_held.set(kLeft);
  input.buttons_went_down.set(kLeft);
  input.pads[2].went = true;
  clear_changes(input);
  EXPECT_TRUE(input.is_held(Key::kW) && input.is_held(MouseButton::kLeft));
  EXPECT_FALSE(input.was_pressed(Key::kW) || input.was_pressed(MouseButton::kLeft));
  EXPECT_TRUE(input.text.empty());
  EXPECT_EQ(input.wheel, 0);
  EXPECT_FALSE(input.pads[2].went);
}

TEST(InputFilter, PassesEverythingThatIsNotTaken) {
  InputFilter filter;
  EXPECT_TRUE(filter.apply(frame(true, true), {}).was_pressed(Key::kW));
  EXPECT_TRUE(filter.apply(frame(true), {}).is_held(Key::kW));
  EXPECT_TRUE(filter.apply(frame(false, false, true), {}).was_released(Key::kW));
}

TEST(InputFilter, ReleasesHeldControlsOnceWhenTheyAreTaken) {
  InputFilter filter;
  filter.apply(frame(true, true), {});
  const InputState taken = filter.apply(frame(true), {.keyboard = true});
  EXPECT_TRUE(taken.was_released(Key::kW));
  EXPECT_FALSE(taken.is_held(Key::kW));
  EXPECT_FALSE(filter.apply(frame(true), {.keyboard = true}).was_released(Key::kW));
}

TEST(InputFilter, HidesControlsPressedWhileTakenUntilTheirRelease) {
  InputFilter filter;
  InputState typed = frame(true, true);
  typed.text.push_back('w');
  EXPECT_TRUE(filter.apply(typed, {.keyboard = true}).text.empty());
  EXPECT_FALSE(filter.apply(frame(true), {}).is_held(Key::kW)) << "it was typed";
  EXPECT_FALSE(filter.apply(frame(false, false, true), {}).was_released(Key::kW));
  EXPECT_TRUE(filter.apply(frame(true, true), {}).is_held(Key::kW));
}

TEST(InputFilter, TakesTheMouseWithoutTheKeyboard) {
  InputFilter filter;
  InputState input = frame(true, true);
  input.buttons_held.set(kLeft);
  input.wheel = 2;
  input.move_px = {3, 4};
  input.pads[0].connected = true;
  const InputState rest = filter.apply(input, {.mouse = true});
  EXPECT_TRUE(rest.is_held(Key::kW));
  EXPECT_FALSE(rest.is_held(MouseButton::kLeft));
  EXPECT_EQ(rest.wheel, 0);
  EXPECT_EQ(rest.move_px, glm::dvec2(0.0));
  EXPECT_TRUE(rest.pads[0].connected);
}

}  // namespace

namespace {

// Gamepads that a test plugs in.
struct Devices {
  std::array<std::optional<PadReading>, kGamepads> slots;
  ReadPad read() {
    return [this](std::size_t slot) { return slots[slot]; };
  }
};

PadReading holding(PadButton button) {
  PadReading reading;
  reading.buttons.set(static_cast<std::size_t>(button));
  return reading;
}

TEST(Gamepads, MissingGamepadsAreNoErrorAndHoldNothing) {
  Devices devices;
  Gamepads pads;
  update_gamepads(devices.read(), pads);
  for (const Gamepad& pad : pads) {
    EXPECT_FALSE(pad.connected || pad.came || pad.went);
    EXPECT_TRUE(pad.held.none());
  }
}

TEST(Gamepads, ReleaseHeldButtonsWhenDisconnected) {
  Devices devices;
  Gamepads pads;
  devices.slots[3] = holding(PadButton::kA);
  devices.slots[3]->axes[0] = -0.5F;
  update_gamepads(devices.read(), pads);
  EXPECT_TRUE(pads[3].connected && pads[3].came);
  EXPECT_TRUE(pads[3].is_held(PadButton::kA));
  EXPECT_EQ(pads[3].axis(PadAxis::kLeftX), -0.5F);
  EXPECT_FALSE(pads[0].connected);
  clear_changes(pads);
  devices.slots[3].reset();
  update_gamepads(devices.read(), pads);
  EXPECT_FALSE(pads[3].connected);
  EXPECT_TRUE(pads[3].went);
  EXPECT_TRUE(pads[3].went_up.test(0)) << "what a lost gamepad held goes up";
  EXPECT_EQ(pads[3].axis(PadAxis::kLeftX), 0);
  clear_changes(pads);
  update_gamepads(devices.read(), pads);
  EXPECT_FALSE(pads[3].went) << "told once";
}

TEST(Gamepads, ChangesAddUpUntilTheyAreCleared) {
  Devices devices;
  Gamepads pads;
  devices.slots[0] = holding(PadButton::kB);
  update_gamepads(devices.read(), pads);
  devices.slots[0] = PadReading{};
  update_gamepads(devices.read(), pads);
  EXPECT_FALSE(pads[0].is_held(PadButton::kB));
  EXPECT_TRUE(pads[0].went_down.test(1));
  EXPECT_TRUE(pads[0].went_up.test(1));
  clear_changes(pads);
  EXPECT_TRUE(pads[0].went_down.none() && pads[0].went_up.none());
}

TEST(Gamepads, AxesStayInTheirRangeForAnyReading) {
  Devices devices;
  Gamepads pads;
  devices.slots[0] = PadReading{
      {}, {9.0F, -9.0F, std::numeric_limits<float>::quiet_NaN(), -INFINITY, -0.5F, 2.0F}};
  update_gamepads(devices.read(), pads);
  EXPECT_EQ(pads[0].axes, (std::array<float, kPadAxes>{1, -1, 0, 0, 0, 1}));
}

}  // namespace

}  // namespace psygen::platform
