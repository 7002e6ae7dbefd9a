#include "engine/input/actions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/engine/input/person.hpp"

namespace psygen::input {
namespace {

using platform::Key;
using platform::MouseButton;
using platform::PadAxis;
using platform::PadButton;
using ::testing::HasSubstr;

class ActionsOfAPerson : public testing::Test {
 protected:
  ActionId add(std::string_view name, std::vector<Binding> bindings) {
    const auto id = actions_.add(name, std::move(bindings));
    EXPECT_TRUE(id) << (id ? "" : id.error().message);
    return id.value_or(0);
  }
  void frame() { actions_.feed(person_.frame()); }
  const ActionState& step(ActionId id) {
    actions_.step();
    return actions_.state(id);
  }
  // Presses and releases in so many steps.
  std::pair<int, int> edges(ActionId id, int steps) {
    int pressed = 0, released = 0;
    for (int i = 0; i < steps; ++i) {
      const ActionState state = step(id);
      pressed += state.pressed ? 1 : 0;
      released += state.released ? 1 : 0;
      EXPECT_FALSE(state.pressed && !state.held);
      EXPECT_FALSE(state.released && state.held);
    }
    return {pressed, released};
  }

  Actions actions_;
  Person person_;
};

TEST_F(ActionsOfAPerson, ArePressedInOneStepHeldInAllAndReleasedInOne) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  EXPECT_EQ(step(jump), ActionState{});
  person_.press(Key::kSpace);
  frame();
  EXPECT_EQ(step(jump), (ActionState{1, true, true, false}));
  EXPECT_EQ(step(jump), (ActionState{1, true, false, false})) << "a second step in the same frame";
  frame();
  EXPECT_EQ(step(jump), (ActionState{1, true, false, false}));
  person_.release(Key::kSpace);
  frame();
  EXPECT_EQ(step(jump), (ActionState{0, false, false, true}));
  EXPECT_EQ(step(jump), ActionState{});
}

TEST_F(ActionsOfAPerson, GetAnotherKeyAndKeepTheGamepadButton) {
  const ActionId jump = add("jump", {{Key::kSpace}, {Key::kJ}, {PadButton::kA}});
  ASSERT_TRUE(actions_.rebind(jump, Key::kK));
  ASSERT_EQ(actions_.bindings(jump).size(), 2U);
  EXPECT_EQ(actions_.bindings(jump)[0].control, Control(Key::kK));
  EXPECT_EQ(actions_.bindings(jump)[1].control, Control(PadButton::kA));
  ASSERT_TRUE(actions_.rebind(jump, PadButton::kY));
  ASSERT_EQ(actions_.bindings(jump).size(), 2U);
  EXPECT_EQ(actions_.bindings(jump)[0].control, Control(PadButton::kY));
  EXPECT_EQ(actions_.bindings(jump)[1].control, Control(Key::kK));
}

TEST_F(ActionsOfAPerson, KnowWhetherAGamepadWasUsedLast) {
  add("jump", {{Key::kSpace}, {PadButton::kA}});
  add("look", {{MouseDirection::kRight}, {PadAxisDirection::kRightStickRight}});
  EXPECT_FALSE(actions_.uses_pad());
  person_.set_button(PadButton::kA, true);
  frame();
  EXPECT_TRUE(actions_.uses_pad());
  person_.set_button(PadButton::kA, false);
  frame();
  EXPECT_TRUE(actions_.uses_pad());
  person_.press(Key::kSpace);
  frame();
  EXPECT_FALSE(actions_.uses_pad());
}

TEST_F(ActionsOfAPerson, LoseNoEdgeInFramesWithoutSteps) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  person_.press(Key::kSpace);
  frame();
  person_.release(Key::kSpace);
  frame();
  frame();
  EXPECT_EQ(step(jump), (ActionState{1, true, true, false}));
  EXPECT_EQ(step(jump), (ActionState{0, false, false, true}));
  person_.press(Key::kSpace);
  frame();
  person_.release(Key::kSpace);
  frame();
  person_.press(Key::kSpace);
  frame();
  EXPECT_EQ(edges(jump, 10), std::pair(2, 1));
}

TEST_F(ActionsOfAPerson, SeeATapWithinAFrameAndATapOfAHeldKey) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  person_.tap(Key::kSpace);
  frame();
  EXPECT_EQ(edges(jump, 5), std::pair(1, 1));
  person_.press(Key::kSpace);
  frame();
  EXPECT_EQ(edges(jump, 5), std::pair(1, 0));
  person_.release(Key::kSpace);
  person_.press(Key::kSpace);
  frame();
  EXPECT_EQ(edges(jump, 5), std::pair(1, 1));
}

TEST_F(ActionsOfAPerson, CountEveryPressForAnyNumberOfStepsPerFrame) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  std::mt19937 random(7);
  int presses = 0, pressed = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i % 12 == 0) person_.press(Key::kSpace), ++presses;
    if (i % 12 == 6) person_.release(Key::kSpace);
    frame();
    pressed += edges(jump, static_cast<int>(random() % 3)).first;
  }
  EXPECT_EQ(pressed + edges(jump, 20).first, presses);
}

TEST_F(ActionsOfAPerson, DropPressesInPairsIfNoStepTakesThem) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  for (int i = 0; i < 100; ++i) {
    person_.press(Key::kSpace);
    frame();
    person_.release(Key::kSpace);
    frame();
  }
  const auto [pressed, released] = edges(jump, 100);
  EXPECT_EQ(pressed, released);
  EXPECT_GT(pressed, 3);
  EXPECT_LT(pressed, 20);
  person_.press(Key::kSpace);
  frame();
  EXPECT_TRUE(step(jump).pressed);
}

TEST_F(ActionsOfAPerson, AreHeldByAnyOfTheirControls) {
  const ActionId fire = add("fire", {{Key::kEnter}, {MouseButton::kLeft}, {PadButton::kA}});
  person_.press(Key::kEnter);
  frame();
  EXPECT_TRUE(step(fire).pressed);
  person_.press(MouseButton::kLeft);
  frame();
  EXPECT_EQ(step(fire), (ActionState{1, true, false, false})) << "it is down already";
  person_.release(Key::kEnter);
  frame();
  EXPECT_FALSE(step(fire).released);
  person_.set_button(PadButton::kA, true);
  frame();
  EXPECT_FALSE(step(fire).pressed);
}

TEST_F(ActionsOfAPerson, AddUpControlsOfOppositeSignWithinOne) {
  const ActionId move = add("move_x", {{Key::kD, 1},
                                       {Key::kA, -1},
                                       {PadAxisDirection::kLeftStickRight, 1, 0.2F},
                                       {PadAxisDirection::kLeftStickLeft, -1, 0.2F}});
  person_.press(Key::kD);
  frame();
  EXPECT_EQ(step(move).value, 1);
  person_.set_axis(PadAxis::kLeftX, 0.8F);
  frame();
  EXPECT_EQ(step(move).value, 1) << "never more than one";
  person_.press(Key::kA);
  frame();
  EXPECT_NEAR(step(move).value, 0.8F, 1e-6F);
  person_.release(Key::kD);
  frame();
  EXPECT_NEAR(step(move).value, -0.2F, 1e-6F);
}

TEST_F(ActionsOfAPerson, IgnoreADeadZoneAndReachOneBeforeTheEnd) {
  const ActionId move = add("move", {{PadAxisDirection::kLeftStickUp, 1, 0.25F}});
  for (const auto& [axis, value] : {std::pair{0.0F, 0.0F},
                                    {0.25F, 0.0F},
                                    {0.6F, 0.5F},
                                    {0.95F, 1.0F},
                                    {1.0F, 1.0F},
                                    {-1.0F, 0.0F}}) {
    person_.set_axis(PadAxis::kLeftY, axis);
    frame();
    EXPECT_NEAR(step(move).value, value, 1e-6F) << axis;
  }
}

TEST_F(ActionsOfAPerson, KeepEveryDirectionOfAStick) {
  const ActionId x =
      add("x", {{PadAxisDirection::kLeftStickRight, 1}, {PadAxisDirection::kLeftStickLeft, -1}});
  const ActionId y =
      add("y", {{PadAxisDirection::kLeftStickUp, 1}, {PadAxisDirection::kLeftStickDown, -1}});
  for (const auto& [radius, speed] : {std::pair{0.1F, 0.0F}, {0.55F, 0.5F}, {0.95F, 1.0F}}) {
    for (int degrees = 0; degrees < 360; ++degrees) {
      const float angle = static_cast<float>(degrees) * std::numbers::pi_v<float> / 180;
      person_.set_axis(PadAxis::kLeftX, radius * std::cos(angle));
      person_.set_axis(PadAxis::kLeftY, radius * std::sin(angle));
      frame();
      EXPECT_NEAR(step(x).value, speed * std::cos(angle), 1e-5F) << degrees;
      EXPECT_NEAR(actions_.state(y).value, speed * std::sin(angle), 1e-5F) << degrees;
    }
  }
}

TEST_F(ActionsOfAPerson, PressAnAxisWithoutFlutterAtItsThreshold) {
  const ActionId fire = add("fire", {{PadAxisDirection::kRightTrigger, 1, 0}});
  int pressed = 0;
  for (int i = 0; i < 100; ++i) {
    person_.set_axis(PadAxis::kRightTrigger, i % 2 == 0 ? 0.51F : 0.46F);
    frame();
    pressed += edges(fire, 1).first;
  }
  EXPECT_EQ(pressed, 1);
  person_.set_axis(PadAxis::kRightTrigger, 0.3F);
  frame();
  EXPECT_TRUE(step(fire).released);
}

TEST_F(ActionsOfAPerson, GetEveryBitOfMovementInExactlyOneStep) {
  const ActionId look =
      add("look_x", {{MouseDirection::kRight, 0.5F}, {MouseDirection::kLeft, -0.5F}});
  person_.move(10, 0);
  frame();
  person_.move(-4, 0);
  frame();
  EXPECT_EQ(step(look).value, 3) << "two frames without a step add up";
  EXPECT_EQ(step(look).value, 0) << "and a second step gets nothing";
  EXPECT_FALSE(actions_.state(look).held);
}

TEST_F(ActionsOfAPerson, ArePressedOnceForEachStepOfTheWheel) {
  const ActionId next = add("next", {{WheelDirection::kUp}});
  person_.roll(3);
  frame();
  EXPECT_EQ(step(next).value, 3);
  EXPECT_EQ(edges(next, 10), std::pair(2, 3)) << "with the one before";
  person_.roll(0.5);
  frame();
  EXPECT_EQ(edges(next, 5).first, 0);
  person_.roll(0.5);
  frame();
  EXPECT_EQ(edges(next, 5).first, 1) << "fine wheels add up";
  person_.roll(-3);
  frame();
  EXPECT_EQ(edges(next, 5).first, 0);
}

TEST_F(ActionsOfAPerson, AreReleasedWhenTheirGamepadIsUnplugged) {
  const ActionId jump = add("jump", {{PadButton::kA}});
  person_.set_button(PadButton::kA, true);
  frame();
  EXPECT_TRUE(step(jump).pressed);
  person_.unplug();
  frame();
  EXPECT_EQ(step(jump), (ActionState{0, false, false, true}));
  person_.set_button(PadButton::kA, true);
  frame();
  EXPECT_TRUE(step(jump).pressed);
}

TEST_F(ActionsOfAPerson, ReadTheSelectedGamepadEvenIfAnotherIsMovedMore) {
  const ActionId move = add("move", {{PadAxisDirection::kLeftStickRight, 1, 0}});
  const ActionId jump = add("jump", {{PadButton::kA}});
  person_.set_axis(PadAxis::kLeftX, 1);
  person_.set_button(PadButton::kA, true);
  person_.set_axis(PadAxis::kLeftX, 0.25F, 3);
  frame();
  EXPECT_EQ(step(move).value, 1) << "the one that is moved most";
  EXPECT_TRUE(actions_.state(jump).held);
  actions_.use_gamepad(3);
  frame();
  EXPECT_NEAR(step(move).value, 0.25F / 0.95F, 1e-6F);
  EXPECT_TRUE(actions_.state(jump).released) << "only the other one holds it";
  person_.set_button(PadButton::kA, true, 3);
  frame();
  EXPECT_TRUE(step(jump).pressed);
  for (const std::size_t absent : {std::size_t{5}, std::size_t{99}}) {
    actions_.use_gamepad(absent);
    frame();
    EXPECT_EQ(step(move).value, 0) << absent;
    EXPECT_FALSE(actions_.state(jump).held) << absent;
  }
  actions_.use_gamepad({});
  frame();
  EXPECT_EQ(step(move).value, 1);
  EXPECT_TRUE(actions_.state(jump).pressed);
}

TEST_F(ActionsOfAPerson, CanBeReboundAtAnyTime) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  person_.press(Key::kSpace);
  frame();
  EXPECT_TRUE(step(jump).pressed);
  ASSERT_TRUE(actions_.set_bindings(jump, {{Key::kJ}}));
  frame();
  EXPECT_EQ(step(jump), (ActionState{0, false, false, true})) << "Space holds it no more";
  person_.press(Key::kJ);
  frame();
  EXPECT_EQ(edges(jump, 4), std::pair(1, 0));
  actions_.reset_bindings();
  EXPECT_EQ(actions_.bindings(jump)[0].control, Control(Key::kSpace));
  frame();
  EXPECT_TRUE(actions_.state(jump).held);
}

TEST_F(ActionsOfAPerson, StartOverAfterClear) {
  const ActionId jump = add("jump", {{Key::kSpace}});
  person_.tap(Key::kSpace);
  person_.move(3, 3);
  frame();
  actions_.step();
  actions_.clear();
  EXPECT_EQ(edges(jump, 4), std::pair(0, 0));
}

TEST(Actions, RejectInvalidNamesAndBindings) {
  Actions actions;
  ASSERT_TRUE(actions.add("jump", {{Key::kSpace}}));
  for (const char* name : {"jump", "", "two words", "\"", "\n"}) {
    const auto refused = actions.add(name);
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, core::ErrorCode::kInvalidArgument);
  }
  EXPECT_FALSE(actions.add(std::string(65, 'a')));
  for (const Binding& binding :
       {Binding{Key::kA, NAN}, Binding{Key::kA, 0}, Binding{Key::kA, 1e9F},
        Binding{Key::kA, 1, NAN}, Binding{Key::kA, 1, 1.0F}, Binding{Key::kA, 1, -0.1F}}) {
    const auto refused = actions.set_bindings(0, {binding});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("action jump, A: "));
  }
  EXPECT_FALSE(actions.set_bindings(0, std::vector<Binding>(33)));
  EXPECT_EQ(actions.bindings(0)[0].control, Control(Key::kSpace)) << "nothing changed";
  for (std::size_t i = 1; i < Actions::kMaxActions; ++i)
    ASSERT_TRUE(actions.add(std::to_string(i)));
  EXPECT_EQ(actions.add("more").error().code, core::ErrorCode::kOverBudget);
}

}  // namespace
}  // namespace psygen::input
