// A session in a window of a Wayland compositor. Built where GLFW has Wayland (since 3.4).
#include <cmath>
#include <functional>

#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/wayland_display.hpp"

namespace psygen::app {
namespace {

using platform::Key;

class SessionOnWayland : public testing::Test {
 protected:
  void SetUp() override {
    display_ = platform::WaylandDisplay::start("de");
    ASSERT_NE(display_, nullptr) << "these tests need sway, xkbcli and Python 3";
    SessionOptions options = short_session();
    options.headless = options.vsync = false;
    options.scene.view_distance_m = 64;
    auto created = Session::create(options);
    ASSERT_TRUE(created) << created.error().message;
    session_ = std::move(*created);
    ASSERT_TRUE(frames_until([&] { return session_->input().focused; }));
    // Windows of sway tile the output.
    ASSERT_TRUE(frames_until([&] { return size() == core::Extent{1280, 800}; }));
  }
  void TearDown() override {
    session_.reset();  // before its display
  }
  bool frames_until(const std::function<bool()>& done) {
    for (int i = 0; i < 2'000 && !done(); ++i) {
      if (!session_->poll() || !session_->tick(session_->home(), 1.0 / 60)) return false;
      text_ += session_->input().text;
      look_px_ += session_->input().look_px;
    }
    return done();
  }
  core::Extent size() const { return session_->window()->framebuffer_size(); }
  void run(const std::string& command) { ASSERT_TRUE(display_->run(command)) << command; }

  std::unique_ptr<platform::WaylandDisplay> display_;
  std::unique_ptr<Session> session_;
  std::string text_;
  glm::dvec2 look_px_{0.0};
};

TEST_F(SessionOnWayland, FollowsTheScaleAndTheSizeOfItsOutput) {
  for (const double scale : {1.5, 2.0, 1.0}) {
    run("sway output HEADLESS-1 scale " + std::to_string(scale));
    EXPECT_TRUE(frames_until([&] {
      return std::abs(session_->window()->content_scale() - scale) < 0.01;
    })) << scale;
    EXPECT_TRUE(frames_until([&] {  // the size in units of the output is rounded down
      return size().width > 1280 - scale && size().height > 800 - scale;
    })) << scale;
  }
  run("sway output HEADLESS-1 resolution 900x600");
  EXPECT_TRUE(frames_until([&] { return session_->picture_size() == core::Extent{900, 600}; }));
  EXPECT_THAT(session_->renderer().validation_messages(), testing::IsEmpty());
}

TEST_F(SessionOnWayland, ReadsTextAndNamesKeysInTheUsersLayout) {
  EXPECT_EQ(session_->window()->label_of(Key::kY), "Z");
  for (const char* key : {"key 21 1", "key 21 0", "key 40 1", "key 40 0"})
    run(key);
  EXPECT_TRUE(frames_until([&] { return text_ == "z\xC3\xA4"; })) << text_;
}

TEST_F(SessionOnWayland, ReleasesHeldKeysWhenAnotherWorkspaceIsShown) {
  run("key 17 1");
  EXPECT_TRUE(frames_until([&] { return session_->input().is_held(Key::kW); }));
  run("sway workspace 2");
  EXPECT_TRUE(frames_until([&] {  // the session goes on
    return !session_->input().focused && !session_->input().is_held(Key::kW);
  }));
  run("key 17 0");
  run("sway workspace 1");
  EXPECT_TRUE(frames_until([&] { return session_->input().focused; }));
  EXPECT_FALSE(session_->input().is_held(Key::kW));
}

TEST_F(SessionOnWayland, CapturesTheCursorBeyondTheEdge) {
  run("move 640 400");
  session_->window()->capture_cursor(true);
  ASSERT_TRUE(frames_until([&] { return session_->input().looking; }));
  for (int i = 0; i < 10; ++i)
    run("by 200 0");
  EXPECT_TRUE(frames_until([&] { return look_px_.x >= 1990; })) << look_px_.x;
}

TEST_F(SessionOnWayland, CoversItsOutputAndKeepsTheClipboard) {
  EXPECT_FALSE(session_->window()->fullscreen());
  ASSERT_TRUE(session_->window()->set_fullscreen(true));
  EXPECT_TRUE(frames_until([&] { return session_->window()->fullscreen(); }));
  EXPECT_TRUE(frames_until([&] { return size() == core::Extent{1280, 800}; }));
  ASSERT_TRUE(session_->window()->set_fullscreen(false));
  EXPECT_TRUE(frames_until([&] { return !session_->window()->fullscreen(); }));
  // Compositors give the clipboard to the window that the user has touched last.
  run("key 17 1");
  run("key 17 0");
  EXPECT_TRUE(frames_until([&] { return session_->input().went_up.any(); }));
  session_->window()->set_clipboard("cairn");
  EXPECT_TRUE(frames_until([&] { return session_->window()->clipboard() == "cairn"; }));
}

}  // namespace
}  // namespace psygen::app
