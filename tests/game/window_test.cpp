// The game in its window, used by keyboard and mouse: title, a named land, walking, pages, saving
// and resuming.
#include "tests/engine/platform/virtual_display.hpp"
#include "tests/game/game_fixture.hpp"
#include "tests/game/made_up_pad.hpp"

namespace cairns {
namespace {

class GameWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    display_ = platform::VirtualDisplay::start("1000x640");
    ASSERT_NE(display_, nullptr) << "Xvfb, openbox or xdotool is missing (tools/setup.sh)";
    std::filesystem::remove_all(folder_);
    options_.folder = folder_;
    options_.size = {640, 360};
    options_.sound = false;
    options_.preset = render::Preset::kLow;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  bool key(const char* name) const { return display_->xdotool({"key", name}); }

  std::unique_ptr<platform::VirtualDisplay> display_;
  std::filesystem::path folder_ = test_folder("game_window");
  GameOptions options_;
};

// Returns the fraction of differing pixels of two images, 0 to 1.
double difference(const image::Image& a, const image::Image& b) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.rgba.size() && i < b.rgba.size(); i += 4)
    differ += std::abs(int{a.rgba[i]} - int{b.rgba[i]}) > 24 ? 1 : 0;
  return static_cast<double>(differ) / static_cast<double>(a.rgba.size() / 4);
}

TEST_F(GameWindow, IsPlayedByKeyboardAndMouseFromTitleToTitle) {
  core::WorldPosition at;
  {
    Running run(options_);
    ASSERT_TRUE(run.open());
    run.frames(30);
    const image::Image title = *run.session->picture();
    // Type the name of a land.
    ASSERT_TRUE(display_->xdotool({"type", "heather"}));
    run.frames(20);
    ASSERT_TRUE(key("Return"));
    ASSERT_TRUE(run.frames_until([&] { return run.game.play() != nullptr; }));
    EXPECT_EQ(run.game.play()->world().seed, seed_of("heather"));
    EXPECT_TRUE(run.session->window()->cursor_captured());
    run.frames(30);
    EXPECT_GT(difference(title, *run.session->picture()), 0.2);
    // Walk forward.
    const Walker& walker = run.game.play()->walker();
    ASSERT_TRUE(display_->xdotool({"keydown", "w"}));
    EXPECT_TRUE(run.frames_until([&] { return walker.walked_m() > 4; }));
    ASSERT_TRUE(display_->xdotool({"keyup", "w"}));
    const double yaw = walker.yaw();
    ASSERT_TRUE(display_->xdotool({"mousemove_relative", "--", "120", "0"}));
    EXPECT_TRUE(run.frames_until([&] { return walker.yaw() > yaw + 0.05; }));
    ASSERT_TRUE(key("space"));
    EXPECT_TRUE(run.frames_until([&] { return walker.gait() == Gait::kAir; }));
    EXPECT_TRUE(run.frames_until([&] { return walker.gait() == Gait::kGround; }));
    // Open and close the map.
    run.frames(10);
    const image::Image play = *run.session->picture();
    ASSERT_TRUE(key("m"));
    EXPECT_TRUE(
        run.frames_until([&] { return difference(play, *run.session->picture()) > 0.2; }, 600));
    ASSERT_TRUE(key("m"));
    run.frames(20);
    // Pause: no time passes in the game.
    ASSERT_TRUE(key("Escape"));
    EXPECT_TRUE(run.frames_until([&] { return !run.session->window()->cursor_captured(); }));
    const double time_s = run.game.play()->progress().time_s;
    run.frames(30);
    EXPECT_EQ(run.game.play()->progress().time_s, time_s);
    // Escape also resumes the game.
    ASSERT_TRUE(key("Escape"));
    EXPECT_TRUE(run.frames_until([&] { return run.session->window()->cursor_captured(); }));
    ASSERT_TRUE(key("Escape"));
    EXPECT_TRUE(run.frames_until([&] { return !run.session->window()->cursor_captured(); }));
    run.frames(5);
    // "Save and quit" is the last button.
    for (int i = 0; i < 6; ++i) {
      ASSERT_TRUE(key("Down"));
      run.frames(6);
    }
    ASSERT_TRUE(key("Return"));
    EXPECT_TRUE(run.frames_until([&] { return run.session->over(); }));
    at = run.game.play()->progress().feet;
    ASSERT_TRUE(run.game.end());
  }
  EXPECT_TRUE(std::filesystem::exists(save_file(folder_, seed_of("heather"))));
  Running again(options_);
  ASSERT_TRUE(again.open());
  again.frames(20);
  // "Credits" is the fourth control below "Continue", and returns to it.
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(key("Down"));
    again.frames(6);
  }
  ASSERT_TRUE(key("Return"));
  again.frames(10);
  ASSERT_TRUE(key("Return"));  // "Back", its only button
  again.frames(10);
  ASSERT_TRUE(key("Return"));  // "Continue" is the first button
  ASSERT_TRUE(again.frames_until([&] { return again.game.play() != nullptr; }));
  EXPECT_EQ(again.game.play()->progress().feet.local, at.local);
}

// The same land with a gamepad alone: its cross, A and B navigate the pages.
TEST_F(GameWindow, IsPlayedByAPadFromTitleToTitle) {
  using platform::PadAxis, platform::PadButton;
  {  // a game whose player has wood: B also lights fires
    auto land = *Land::load(3);
    auto play = *Play::create(land->world, land->registry);
    std::filesystem::create_directories(folder_);
    auto saved = Saved::open(save_file(folder_, 3), *play);
    ASSERT_TRUE(saved) << saved.error().message;
    Progress progress = play->progress();
    progress.stock.wood = 6;
    ASSERT_TRUE(play->resume(progress, play->edits()));
    ASSERT_TRUE(saved->put(*play).and_then([&] { return saved->wait(); }));
  }
  MadeUpPad pad;
  options_.size = {320, 180};
  Running run(options_);
  ASSERT_TRUE(run.open());
  run.frames(20);
  const auto press = [&](PadButton button) {
    pad.hold(button, true);
    run.frames(3);
    pad.hold(button, false);
    run.frames(6);
  };
  press(PadButton::kA);  // "Continue"
  ASSERT_TRUE(run.frames_until([&] { return run.game.play() != nullptr; }));
  run.frames(10);
  EXPECT_TRUE(run.session->actions().uses_pad());
  EXPECT_EQ(key_of(run.session->actions(), Act::kUse, run.session->window()), "Gamepad X");
  const Walker& walker = run.game.play()->walker();
  pad.move(PadAxis::kLeftY, -1);
  EXPECT_TRUE(run.frames_until([&] { return walker.walked_m() > 4; }));
  pad.move(PadAxis::kLeftY, 0);
  const double yaw = walker.yaw();
  pad.move(PadAxis::kRightX, 1);
  EXPECT_TRUE(run.frames_until([&] { return walker.yaw() > yaw + 0.2; }));
  pad.move(PadAxis::kRightX, 0);
  press(PadButton::kStart);
  EXPECT_EQ(run.game.page(), Page::kPause);
  for (int i = 0; i < 4; ++i)
    press(PadButton::kDown);
  press(PadButton::kA);
  EXPECT_EQ(run.game.page(), Page::kSettings);
  press(PadButton::kB);
  EXPECT_EQ(run.game.page(), Page::kPause);
  press(PadButton::kB);
  EXPECT_EQ(run.game.page(), Page::kNone);
  press(PadButton::kBack);
  EXPECT_EQ(run.game.page(), Page::kMap);
  press(PadButton::kB);
  EXPECT_EQ(run.game.page(), Page::kNone);
  EXPECT_EQ(run.game.play()->progress().stock.wood, 6) << "leaving a page lights no fire";
  press(PadButton::kB);
  EXPECT_EQ(run.game.play()->progress().stock.wood, 6 - kWoodOfFire);
  // After a key press, hints name keys instead of gamepad buttons.
  ASSERT_TRUE(key("e"));
  EXPECT_TRUE(run.frames_until([&] { return !run.session->actions().uses_pad(); }, 100));
  EXPECT_EQ(key_of(run.session->actions(), Act::kUse, run.session->window()), "E");
  press(PadButton::kStart);
  for (int i = 0; i < 5; ++i)
    press(PadButton::kDown);
  press(PadButton::kA);
  EXPECT_EQ(run.game.page(), Page::kTitle);
  EXPECT_EQ(run.game.play(), nullptr);
}

}  // namespace
}  // namespace cairns
