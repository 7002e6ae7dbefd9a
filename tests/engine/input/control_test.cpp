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

namespace {

using platform::Key;

TEST(BindingCapture, TakesTheNextControlOfEveryKind) {
  const auto captured = [](auto act) {
    Person person;
    BindingCapture capture(person.frame());
    EXPECT_EQ(capture.update(person.frame()), std::nullopt);
    act(person);
    return capture.update(person.frame());
  };
  EXPECT_EQ(captured([](Person& p) { p.press(Key::kF5); }), Control(Key::kF5));
  EXPECT_EQ(captured([](Person& p) { p.tap(Key::kF5); }), Control(Key::kF5));
  EXPECT_EQ(captured([](Person& p) { p.press(platform::MouseButton::k5); }),
            Control(platform::MouseButton::k5));
  EXPECT_EQ(captured([](Person& p) { p.roll(-1); }), Control(WheelDirection::kDown));
  EXPECT_EQ(captured([](Person& p) { p.set_button(platform::PadButton::kStart, true); }),
            Control(platform::PadButton::kStart));
  EXPECT_EQ(captured([](Person& p) { p.set_axis(platform::PadAxis::kRightY, -0.9F); }),
            Control(PadAxisDirection::kRightStickDown));
}

TEST(BindingCapture, DistinguishesShiftsAndIgnoresMouseMovement) {
  Person person;
  BindingCapture capture(person.frame());
  person.move(500, 500);
  person.press(Key::kShift);
  person.press(Key::kRightShift);
  EXPECT_EQ(capture.update(person.frame()), Control(Key::kRightShift));
}

TEST(BindingCapture, WaitsUntilHeldControlsAreReleased) {
  Person person;
  person.press(Key::kEnter);
  person.set_axis(platform::PadAxis::kLeftTrigger, 0.9F);
  BindingCapture capture(person.frame());
  EXPECT_EQ(capture.update(person.frame()), std::nullopt);
  person.set_axis(platform::PadAxis::kLeftTrigger, 0.0F);
  EXPECT_EQ(capture.update(person.frame()), std::nullopt);
  person.set_axis(platform::PadAxis::kLeftTrigger, 0.9F);
  EXPECT_EQ(capture.update(person.frame()), Control(PadAxisDirection::kLeftTrigger));
}

}  // namespace

}  // namespace psygen::input
