#include "engine/input/control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/engine/input/person.hpp"

namespace psygen::input {
namespace {

using platform::Key;
using platform::PadAxis;
using platform::PadButton;
using ::testing::HasSubstr;

TEST(Control, EveryControlHasAUniqueNameByWhichItIsFound) {
  std::set<std::string_view> names;
  for (const Control control : all_controls()) {
    EXPECT_TRUE(names.insert(name_of(control)).second) << name_of(control);
    EXPECT_EQ(control_named(name_of(control)), control);
  }
  EXPECT_GT(names.size(), 130u);
}

TEST(Control, AWrongNameIsReportedWithTheNearestOne) {
  const auto wrong = control_named("Gamepad Left Stik Up");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_THAT(wrong.error().message, HasSubstr("did you mean \"Gamepad Left Stick Up\"?"));
  EXPECT_THAT(control_named("quite something else").error().message,
              HasSubstr("examples: \"Space\""));
}

TEST(Control, HalvesOfAnAxisAreSeparateControls) {
  Person person;
  person.set_axis(PadAxis::kLeftY, -0.75F);
  person.set_axis(PadAxis::kRightTrigger, 0.5F);
  const platform::InputState input = person.frame();
  EXPECT_EQ(read(PadAxisDirection::kLeftStickDown, input).value, 0.75);
  EXPECT_EQ(read(PadAxisDirection::kLeftStickUp, input).value, 0);
  EXPECT_EQ(read(PadAxisDirection::kRightTrigger, input).value, 0.5);
}

TEST(Control, WheelAndMouseMoveInOneDirectionAtATime) {
  Person person;
  person.roll(-2);
  person.move(5, -3);
  const platform::InputState input = person.frame();
  EXPECT_EQ(read(WheelDirection::kDown, input).value, 2);
  EXPECT_EQ(read(WheelDirection::kUp, input).value, 0);
  EXPECT_EQ(read(MouseDirection::kRight, input).value, 5);
  EXPECT_EQ(read(MouseDirection::kUp, input).value, 3);
}

TEST(Control, TheStrongestGamepadCountsUnlessOneIsChosen) {
  platform::InputState input;
  input.pads[0].axes[0] = 0.25F;
  input.pads[5].axes[0] = 0.75F;
  input.pads[5].held.set(0);
  EXPECT_EQ(read(PadAxisDirection::kLeftStickRight, input).value, 0.75);
  EXPECT_EQ(read(PadAxisDirection::kLeftStickRight, input, 0).value, 0.25);
  EXPECT_EQ(read(PadButton::kA, input).value, 1);
  EXPECT_EQ(read(PadButton::kA, input, 0).value, 0);
}

TEST(Control, IsNeverNotANumber) {
  platform::InputState input;
  input.wheel = std::numeric_limits<double>::quiet_NaN();
  input.move_px = {std::numeric_limits<double>::infinity(), 1e300};
  input.pads[0].axes[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(read(WheelDirection::kUp, input).value, 0);
  EXPECT_EQ(read(MouseDirection::kRight, input).value, 0);
  EXPECT_EQ(read(MouseDirection::kDown, input).value, 1e6);
  EXPECT_EQ(read(PadAxisDirection::kLeftStickRight, input).value, 0);
}

}  // namespace
}  // namespace psygen::input
