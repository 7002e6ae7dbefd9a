#include "engine/platform/window.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::platform {
namespace {

// Polls until `condition(input)` holds; false when it does not within so many waits for events.
template <class Condition>
bool eventually(Window& window, const Condition& condition, int waits = 300) {
  for (int i = 0; i < waits; ++i) {
    if (condition(window.poll())) return true;
    window.wait_events(0.05);
  }
  return false;
}

class WindowOnADisplay : public testing::Test {
 protected:
  void SetUp() override {
    display_ = VirtualDisplay::start();
    ASSERT_NE(display_, nullptr) << "these tests need xvfb, openbox and xdotool";
    auto created = Window::create({"psygen window test", {640, 360}, true});
    ASSERT_TRUE(created) << created.error().message;
    window_ = std::move(*created);
    ASSERT_TRUE(eventually(*window_, [&](const InputState&) {
      return window_->framebuffer_size() == core::Extent{640, 360};
    }));
  }
  // The window manager gives the window the keyboard; the pointer is moved to its centre.
  void take_focus() {
    ASSERT_TRUE(display_->xdotool({"search", "--sync", "--onlyvisible", "--name",
                                   "psygen window test", "windowactivate", "--sync", "mousemove",
                                   "--window", "%1", "320", "180"}));
    window_->poll();
  }

  std::unique_ptr<VirtualDisplay> display_;
  std::unique_ptr<Window> window_;
};

TEST(Window, WithoutADisplayCreationFailsWithOneSentence) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const auto created = Window::create({});
  ASSERT_FALSE(created);
  EXPECT_EQ(created.error().code, core::ErrorCode::kNoDevice);
  EXPECT_EQ(created.error().message.rfind("no window can be opened here: ", 0), 0U);
  EXPECT_EQ(created.error().message.find('\n'), std::string::npos);
}

TEST_F(WindowOnADisplay, ReportsResizesWithTheNewSize) {
  EXPECT_FALSE(window_->poll().resized);
  window_->set_size({801, 455});
  bool told = false;
  EXPECT_TRUE(eventually(*window_, [&](const InputState& input) {
    told = told || input.resized;
    return told && window_->framebuffer_size() == core::Extent{801, 455};
  }));
}

TEST_F(WindowOnADisplay, CoversTheScreenAndRestoresItsSizeAndPosition) {
  ASSERT_TRUE(display_->xdotool({"search", "--sync", "--onlyvisible", "--name",
                                 "psygen window test", "windowmove", "%1", "210", "130"}));
  window_->set_size({700, 400});
  const auto has = [&](core::Extent size) {
    return eventually(*window_,
                      [&](const InputState&) { return window_->framebuffer_size() == size; });
  };
  ASSERT_TRUE(has({700, 400}));
  const auto geometry = [&] {
    return display_->output({"xdotool", "search", "--onlyvisible", "--name", "psygen window test",
                             "getwindowgeometry", "--shell", "%1"});
  };
  std::string before = geometry(), last;
  ASSERT_TRUE(eventually(*window_, [&](const InputState&) {  // the window manager is done with it
    last = std::exchange(before, geometry());
    return before == last && before.find("X=2") != std::string::npos;
  })) << before;
  for (int time = 0; time < 2; ++time) {
    EXPECT_FALSE(window_->fullscreen());
    ASSERT_TRUE(window_->set_fullscreen(true));
    EXPECT_TRUE(window_->fullscreen());
    EXPECT_TRUE(window_->set_fullscreen(true)) << "it is already";
    EXPECT_TRUE(has({1280, 1024}));
    ASSERT_TRUE(window_->set_fullscreen(false));
    EXPECT_TRUE(has({700, 400}));
    EXPECT_TRUE(eventually(*window_, [&](const InputState&) { return geometry() == before; }))
        << before << geometry();
  }
}

TEST_F(WindowOnADisplay, StaysFullScreenWhenAnotherWindowIsUsed) {
  take_focus();
  ASSERT_TRUE(window_->set_fullscreen(true));
  ASSERT_TRUE(eventually(*window_, [&](const InputState&) {
    return window_->framebuffer_size() == core::Extent{1280, 1024};
  }));
  auto other = Window::create({"another window", {100, 100}, true});
  ASSERT_TRUE(other) << other.error().message;
  ASSERT_TRUE(display_->xdotool({"search", "--sync", "--onlyvisible", "--name", "another window",
                                 "windowactivate", "--sync"}));
  for (int i = 0; i < 10; ++i) {
    window_->poll();
    window_->wait_events(0.01);
  }
  EXPECT_FALSE(window_->minimised());
  EXPECT_TRUE(window_->fullscreen());
}

TEST_F(WindowOnADisplay, ReportsTheContentScale) {
  EXPECT_EQ(window_->content_scale(), 1.0F);
  window_.reset();  // the window system is asked when the first window is made
  display_->output({"xprop", "-root", "-format", "RESOURCE_MANAGER", "8s", "-set",
                    "RESOURCE_MANAGER", "Xft.dpi: 192"});
  auto created = Window::create({"psygen window test", {640, 360}, true});
  ASSERT_TRUE(created) << created.error().message;
  window_ = std::move(*created);
  EXPECT_NEAR(window_->content_scale(), 2.0F, 0.05F);
}

TEST_F(WindowOnADisplay, HasTheNameOfItsProgramAsClass) {
  EXPECT_EQ(display_->output({"xprop", "-name", "psygen window test", "WM_CLASS"}),
            "WM_CLASS(STRING) = \"psygen_test_platform\", \"psygen_test_platform\"\n");
}

TEST_F(WindowOnADisplay, HasNoPixelsWhileItIsMinimised) {
  window_->minimise();
  EXPECT_TRUE(eventually(*window_, [&](const InputState&) { return window_->minimised(); }));
  EXPECT_EQ(window_->framebuffer_size(), (core::Extent{0, 0}));
  window_->restore();
  EXPECT_TRUE(eventually(*window_, [&](const InputState&) { return !window_->minimised(); }));
  EXPECT_EQ(window_->framebuffer_size(), (core::Extent{640, 360}));
}

TEST_F(WindowOnADisplay, ClosesOnTheUsersRequest) {
  EXPECT_FALSE(window_->should_close());
  take_focus();
  // The first key of a new display changes its keyboard; the window manager then rebinds its own
  // keys and may miss that press.
  bool closes = false;
  for (int press = 0; press < 10 && !closes; ++press) {
    ASSERT_TRUE(display_->xdotool({"key", "alt+F4"}));
    closes = eventually(
        *window_, [&](const InputState&) { return window_->should_close(); }, 30);
  }
  EXPECT_TRUE(closes);
}

TEST_F(WindowOnADisplay, ReportsHeldAndPressedKeys) {
  take_focus();
  ASSERT_TRUE(display_->xdotool({"keydown", "w"}));
  EXPECT_TRUE(
      eventually(*window_, [](const InputState& input) { return input.was_pressed(Key::kW); }));
  const InputState later = window_->poll();
  EXPECT_TRUE(later.is_held(Key::kW));
  EXPECT_FALSE(later.was_pressed(Key::kW));
  ASSERT_TRUE(display_->xdotool({"keyup", "w"}));
  EXPECT_TRUE(
      eventually(*window_, [](const InputState& input) { return !input.is_held(Key::kW); }));
  ASSERT_TRUE(display_->xdotool({"key", "F12"}));
  EXPECT_TRUE(
      eventually(*window_, [](const InputState& input) { return input.was_pressed(Key::kF12); }));
}

TEST_F(WindowOnADisplay, ReportsEventsOfABusyProgram) {
  take_focus();
  ASSERT_TRUE(display_->xdotool({"key", "F3"}));
  for (int i = 0; i < 20; ++i) {
    window_->wait_events(0.01);
    window_->keep_alive();
  }
  EXPECT_TRUE(
      eventually(*window_, [](const InputState& input) { return input.was_pressed(Key::kF3); }));
}

TEST_F(WindowOnADisplay, MouseTurnsTheCameraOnlyWhileTheRightButtonIsDown) {
  take_focus();
  glm::dvec2 look{0.0};
  const auto sum = [&](const InputState& input) {
    look += input.look_px;
    return false;
  };
  ASSERT_TRUE(display_->xdotool({"mousemove_relative", "--", "30", "0"}));
  for (int i = 0; i < 5; ++i) {
    sum(window_->poll());
    window_->wait_events(0.01);
  }
  EXPECT_EQ(look, glm::dvec2(0.0));
  ASSERT_TRUE(display_->xdotool({"mousedown", "3"}));
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) { return input.looking; }));
  ASSERT_TRUE(display_->xdotool({"mousemove_relative", "--", "25", "10"}));
  EXPECT_TRUE(eventually(*window_, [&](const InputState& input) {
    sum(input);
    return look.x > 0 && look.y > 0;
  }));
  ASSERT_TRUE(display_->xdotool({"mouseup", "3"}));
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) { return !input.looking; }));
}

TEST_F(WindowOnADisplay, TheWheelCountsItsSteps) {
  take_focus();
  ASSERT_TRUE(display_->xdotool({"click", "--repeat", "3", "--delay", "1", "4"}));
  double steps = 0;
  EXPECT_TRUE(eventually(*window_, [&](const InputState& input) {
    steps += input.wheel;
    return steps >= 3;
  }));
  EXPECT_EQ(steps, 3.0);
}

TEST_F(WindowOnADisplay, ReportsAllMouseButtonsAndThePointer) {
  take_focus();
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) {
    return std::abs(input.pointer_px.x - 320) < 2 && std::abs(input.pointer_px.y - 180) < 2;
  }));
  // X numbers the buttons left, middle, right; 4 to 7 are wheels, 8 and 9 the next ones.
  for (const auto& [number, button] : {std::pair{"1", MouseButton::kLeft},
                                       {"2", MouseButton::kMiddle},
                                       {"3", MouseButton::kRight},
                                       {"8", MouseButton::k4},
                                       {"9", MouseButton::k5}}) {
    ASSERT_TRUE(display_->xdotool({"mousedown", number}));
    EXPECT_TRUE(eventually(*window_, [&, which = button](const InputState& input) {
      return input.was_pressed(which) && input.is_held(which);
    })) << number;
    ASSERT_TRUE(display_->xdotool({"mouseup", number}));
    EXPECT_TRUE(eventually(*window_, [&, which = button](const InputState& input) {
      return input.was_released(which) && !input.is_held(which);
    })) << number;
  }
}

TEST_F(WindowOnADisplay, CapturesTheCursorBeyondTheEdgeAndReleasesIt) {
  take_focus();
  EXPECT_FALSE(window_->cursor_captured());
  window_->capture_cursor(true);
  EXPECT_TRUE(window_->cursor_captured());
  glm::dvec2 moved{0.0};
  for (int i = 0; i < 40; ++i) {  // farther than the screen is wide
    ASSERT_TRUE(display_->xdotool({"mousemove_relative", "--", "50", "0"}));
    EXPECT_TRUE(eventually(*window_, [&](const InputState& input) {
      EXPECT_TRUE(input.captured && input.looking);
      moved += input.look_px;
      return moved.x > 45 * (i + 1);
    })) << moved.x;
  }
  window_->capture_cursor(false);
  EXPECT_FALSE(window_->poll().looking);
  EXPECT_FALSE(window_->cursor_captured());
}

TEST_F(WindowOnADisplay, LeavesTheRightButtonToGamesOnRequest) {
  take_focus();
  window_->set_right_button_looks(false);
  ASSERT_TRUE(display_->xdotool({"mousedown", "3"}));
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) {
    EXPECT_FALSE(input.looking);
    return input.is_held(MouseButton::kRight);
  }));
  ASSERT_TRUE(display_->xdotool({"mouseup", "3"}));
}

TEST_F(WindowOnADisplay, ReadsUnicodeText) {
  take_focus();
  std::string text;
  display_->output({"setxkbmap", "de"});
  ASSERT_TRUE(display_->xdotool({"key", "a", "adiaeresis", "EuroSign", "exclam"}));
  EXPECT_TRUE(eventually(*window_, [&](const InputState& input) {
    text += input.text;
    return text.find('!') != std::string::npos;
  })) << text;
  EXPECT_EQ(text, "a\xC3\xA4\xE2\x82\xAC!");
}

TEST_F(WindowOnADisplay, KnowsBothShiftsApartAndAsOne) {
  take_focus();
  ASSERT_TRUE(display_->xdotool({"keydown", "Shift_L"}));
  ASSERT_TRUE(
      eventually(*window_, [](const InputState& input) { return input.is_held(Key::kLeftShift); }));
  ASSERT_TRUE(display_->xdotool({"keydown", "Shift_R"}));
  ASSERT_TRUE(eventually(*window_,
                         [](const InputState& input) { return input.is_held(Key::kRightShift); }));
  ASSERT_TRUE(display_->xdotool({"keyup", "Shift_L"}));
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) {
    EXPECT_TRUE(input.is_held(Key::kShift)) << "the right one is still down";
    return !input.is_held(Key::kLeftShift);
  }));
  ASSERT_TRUE(display_->xdotool({"keyup", "Shift_R"}));
  EXPECT_TRUE(eventually(*window_, [](const InputState& input) {
    return input.was_released(Key::kShift) && !input.is_held(Key::kShift);
  }));
}

TEST_F(WindowOnADisplay, NamesKeyCapsAndKeepsTheClipboard) {
  EXPECT_EQ(window_->label_of(Key::kY), "Y");
  EXPECT_EQ(window_->label_of(Key::kSpace), "Space");
  EXPECT_EQ(window_->label_of(Key::kShift), "Shift");
  window_->set_clipboard("h\xC3\xB6he");
  EXPECT_EQ(window_->clipboard(), "h\xC3\xB6he");
  EXPECT_EQ(window_->gamepad_name(0), "");
  EXPECT_EQ(window_->gamepad_name(99), "");
}

TEST_F(WindowOnADisplay, ClosesByRequestAndOutlivesAnotherWindow) {
  auto second = Window::create({"second", {100, 100}, false});
  ASSERT_TRUE(second) << second.error().message;
  second->reset();
  window_->set_title("still here");
  window_->poll();
  EXPECT_FALSE(window_->should_close());
  window_->request_close();
  EXPECT_TRUE(window_->should_close());
}

}  // namespace
}  // namespace psygen::platform
