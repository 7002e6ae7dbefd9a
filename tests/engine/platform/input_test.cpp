#include "engine/platform/input.hpp"

#include <gtest/gtest.h>

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
}  // namespace psygen::platform
