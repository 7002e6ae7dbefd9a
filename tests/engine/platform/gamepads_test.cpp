#include "engine/platform/gamepads.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psygen::platform {
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
