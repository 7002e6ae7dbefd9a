#include "engine/input/binding_capture.hpp"

#include <gtest/gtest.h>

#include "tests/engine/input/person.hpp"

namespace psygen::input {
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
