// A session without a flight, as programs with their own loop use it.
#include "engine/app/session.hpp"

#include <cmath>

#include "engine/render/renderer.hpp"
#include "engine/scene/meshes/requested_places.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/state.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

TEST(Session, IsDrivenByTheProgramsLoopUntilItIsClosed) {
  auto session = Session::create(short_session());
  ASSERT_TRUE(session) << session.error().message;
  const core::CameraPose pose = (*session)->home();
  ASSERT_TRUE((*session)->prepare(pose));
  int ticks = 0;
  while ((*session)->poll()) {
    EXPECT_DOUBLE_EQ((*session)->now_s(), 0.25 * ticks);
    ASSERT_TRUE((*session)->tick(pose, 0.25));
    EXPECT_EQ((*session)->scene().statistics().drawn.holes, 0u);
    if (++ticks == 3) (*session)->close();
  }
  EXPECT_EQ(ticks, 3);
  EXPECT_TRUE((*session)->over());
  EXPECT_FALSE((*session)->stopped());
  EXPECT_EQ((*session)->trace(), nullptr);
  EXPECT_TRUE((*session)->renderer().validation_messages().empty());
}

TEST(Session, DrawsTheNextTickAtTheTimeOfItsClock) {
  std::vector<double> drawn_s;
  SessionOptions options = short_session();
  options.plugins.push_back(
      {.name = "clock", .add_systems = [&](scene::Systems& systems) -> core::Result<void> {
         systems.frame.add("watch",
                           [&](const scene::Clock& clock) { drawn_s.push_back(clock.now_s); });
         return {};
       }});
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const core::CameraPose pose = (*session)->home();
  ASSERT_TRUE((*session)->tick(pose, 0.25));
  for (const double now_s : {2.0, 0.5}) {
    (*session)->set_now(now_s);
    EXPECT_EQ((*session)->now_s(), now_s);
    ASSERT_TRUE((*session)->tick(pose, 0.25));
    EXPECT_EQ((*session)->now_s(), now_s + 0.25);
  }
  EXPECT_EQ(drawn_s, (std::vector<double>{0, 2, 0.5}));
}

TEST(Session, HasAClockThatCountsMicrosecondsAndRefusesTimesBeyond) {
  auto session = Session::create(short_session());
  ASSERT_TRUE(session) << session.error().message;
  for (const double dt_s : {1e15, 1.1e6, -1e-9, HUGE_VAL, std::nan("")}) {
    const auto ticked = (*session)->tick((*session)->home(), dt_s);
    ASSERT_FALSE(ticked) << dt_s;
    EXPECT_EQ(ticked.error().code, core::ErrorCode::kInvalidArgument);
    EXPECT_NE(ticked.error().message.find("0 to 1000000 seconds"), std::string::npos);
    EXPECT_FALSE((*session)->over());
  }
  EXPECT_TRUE((*session)->tick((*session)->home(), 1e6));
  EXPECT_EQ((*session)->now_s(), 1e6);
  (*session)->set_now(1e15);
  EXPECT_EQ((*session)->now_s(), 1e6) << "ignored";
  (*session)->set_now(1e9);
  const auto ticked = (*session)->tick((*session)->home(), 1);
  ASSERT_FALSE(ticked);
  EXPECT_EQ(ticked.error().message,
            "the clock cannot pass 1000000000 seconds; set_now() sets it back");
  EXPECT_TRUE((*session)->tick((*session)->home(), 0));
}

TEST(Session, EndsOnceTheStopFlagIsSet) {
  std::atomic<bool> stop = false;
  SessionOptions options = short_session();
  options.stop = &stop;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE((*session)->poll());
  stop = true;
  EXPECT_FALSE((*session)->poll());
  EXPECT_TRUE((*session)->stopped());
}

TEST(Session, CallsPluginsInAnyLoop) {
  std::vector<std::string> calls;
  SessionOptions options = short_session();
  options.plugins.push_back({.name = "counter",
                             .on_start = [&](Session&) { calls.push_back("start"); },
                             .on_frame =
                                 [&](Session&, double dt_s) {
                                   EXPECT_EQ(dt_s, 0.5);
                                   calls.push_back("frame");
                                 }});
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_TRUE(calls.empty()) << "before the first tick";
  for (int i = 0; i < 2; ++i)
    ASSERT_TRUE((*session)->tick((*session)->home(), 0.5));
  EXPECT_EQ(calls, (std::vector<std::string>{"start", "frame", "frame"}));
}

TEST(Session, SavesTheImageOfTheLastTickAndChangesItsPreset) {
  SessionOptions options = short_session();
  options.preset = render::Preset::kLow;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const TemporaryFolder folder;
  const auto file = folder / "picture.png";
  EXPECT_FALSE((*session)->save_picture(file)) << "there is no image";
  EXPECT_TRUE((*session)->take_saved().empty());
  ASSERT_TRUE((*session)->tick((*session)->home(), 0));
  ASSERT_TRUE((*session)->save_picture(file));
  EXPECT_EQ((*session)->take_saved(), std::vector{file});
  EXPECT_TRUE((*session)->take_saved().empty()) << "reported once";
  scene::State& state = scene::state_of((*session)->scene());
  EXPECT_TRUE(state.facts.near_detail);
  ASSERT_TRUE((*session)->scene().request_place((*session)->home().position, 40));
  EXPECT_FALSE(state.meshes.places.places[0].stale);
  ASSERT_TRUE((*session)->set_preset(render::Preset::kMedium));
  EXPECT_EQ(state.facts.shadows, (*session)->renderer().casts_shadows());
  EXPECT_FALSE(state.facts.near_detail);
  EXPECT_TRUE(state.meshes.places.places[0].stale) << "the preset changes the distance of trees";
  ASSERT_TRUE((*session)->tick((*session)->home(), 0));
  EXPECT_EQ((*session)->renderer().preset(), render::Preset::kMedium);
}

TEST(Session, TheGovernorIgnoresImagesCapturedByPlugins) {
  const TemporaryFolder folder;
  SessionOptions options = short_session();
  options.scene.virtual_time = false;
  bool takes = false;
  options.plugins.push_back({.name = "camera", .on_frame = [&](Session& session, double) {
                               if (!takes) return;
                               EXPECT_TRUE(session.save_picture(folder / "a.png"));
                             }});
  const auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  for (const bool now : {false, true, false}) {
    takes = now;
    ASSERT_TRUE((*session)->tick((*session)->home(), 0.01));
    EXPECT_EQ(scene::state_of((*session)->scene()).input.frame_ms > 0, !takes);
  }
}

TEST(Session, RejectsInvalidPosesTargetsAndNames) {
  SessionOptions options = short_session();
  for (const double hz : {-1.0, std::nan(""), 1e9, 1e300}) {
    options.target_hz = hz;
    const auto none = Session::create(options);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, core::ErrorCode::kInvalidArgument) << hz;
  }
  options.target_hz.reset();
  const auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  core::CameraPose nowhere = (*session)->home();
  nowhere.position.local.x = std::nan("");
  const auto prepared = (*session)->prepare(nowhere);
  ASSERT_FALSE(prepared);
  EXPECT_EQ(prepared.error().code, core::ErrorCode::kInvalidArgument);
  ASSERT_TRUE((*session)->tick((*session)->home(), 0));
  const auto saved = (*session)->save_picture("x.jpg");
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().message, "x.jpg: the name of an image must end in .png");
}

TEST(Session, BeginsEveryFixedStepWithItsActionsAndReplaysThem) {
  const auto fly = [](const input::Recording* recorded) {
    std::vector<float> seen;
    SessionOptions options = short_session();
    options.plugins.push_back({.name = "game", .on_step = [&](Session& session, double) {
                                 seen.push_back(session.actions().state(0).value);
                               }});
    auto session = Session::create(options);
    EXPECT_TRUE(session) << session.error().message;
    input::Actions& actions = (*session)->actions();
    EXPECT_TRUE(actions.add("look", {{input::MouseDirection::kRight, 0.5F}}));
    if (recorded != nullptr) {
      auto replay = input::Replay::create(*recorded, actions, 1.0 / 60);
      EXPECT_TRUE(replay) << replay.error().message;
      (*session)->replay(std::move(*replay));
    }
    for (int i = 0; i < 4; ++i) {
      platform::InputState input;
      input.move_px.x = i + 1;
      actions.feed(input);
      EXPECT_TRUE((*session)->tick((*session)->home(), i == 1 ? 0.04 : 0.02));
    }
    return seen;
  };
  const std::vector<float> live = fly(nullptr);
  ASSERT_GE(live.size(), 3u);
  EXPECT_NE(live, std::vector<float>(live.size(), 0.0F));
  input::Actions actions;
  ASSERT_TRUE(actions.add("look"));
  input::Recording recording(actions, 1.0 / 60);
  std::vector<float> wanted;
  for (std::size_t i = 0; i < live.size(); ++i) {
    wanted.push_back(0.1F * static_cast<float>(i));
    ASSERT_TRUE(recording.add(std::vector<input::ActionState>{{wanted.back()}}));
  }
  EXPECT_EQ(fly(&recording), wanted);
}

TEST(Session, TakesItsActionsFromTheUserAgainOneStepAfterTheEndOfAReplay) {
  std::vector<float> seen;
  std::vector<bool> replayed;
  SessionOptions options = short_session();
  options.plugins.push_back({.name = "game", .on_step = [&](Session& session, double) {
                               seen.push_back(session.actions().state(0).value);
                               replayed.push_back(session.replays());
                             }});
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_FALSE((*session)->replays());
  input::Actions& actions = (*session)->actions();
  ASSERT_TRUE(actions.add("look", {{input::MouseDirection::kRight}}));
  input::Recording recording(actions, 1.0 / 60);
  for (const float value : {0.25F, 0.5F})
    ASSERT_TRUE(recording.add(std::vector<input::ActionState>{{value}}));
  auto replay = input::Replay::create(recording, actions, 1.0 / 60);
  ASSERT_TRUE(replay) << replay.error().message;
  (*session)->replay(std::move(*replay));
  EXPECT_TRUE((*session)->replays());
  // A tick runs the steps of the time before it: none in the first tick.
  for (int i = 0; i < 6; ++i) {
    platform::InputState input;
    input.move_px.x = 7;
    actions.feed(input);
    ASSERT_TRUE((*session)->tick((*session)->home(), 1.0 / 60));
  }
  EXPECT_EQ(seen, (std::vector<float>{0.25F, 0.5F, 0, 7, 7}));
  EXPECT_EQ(replayed, (std::vector<bool>{true, true, false, false, false}));
  EXPECT_FALSE((*session)->replays());
}

TEST(Session, StandsStillAndContinuesDrawingWhilePaused) {
  std::vector<double> told;
  SessionOptions options = short_session();
  int steps = 0;
  options.plugins.push_back({.name = "clock",
                             .on_step = [&](Session&, double) { ++steps; },
                             .on_frame = [&](Session&, double dt_s) { told.push_back(dt_s); }});
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const core::CameraPose pose = (*session)->home();
  ASSERT_TRUE((*session)->tick(pose, 0.5));
  (*session)->set_paused(true);
  const std::uint64_t frame = (*session)->scene().drawn().frame;
  ASSERT_TRUE((*session)->tick(pose, 0.5));  // the steps of the time before
  const int steps_before = steps;
  for (int i = 0; i < 2; ++i)
    ASSERT_TRUE((*session)->tick(pose, 0.5));
  EXPECT_EQ(steps, steps_before);
  EXPECT_TRUE((*session)->paused());
  EXPECT_EQ((*session)->now_s(), 0.5);
  EXPECT_EQ((*session)->scene().drawn().frame, frame + 3) << "drawing continues";
  (*session)->set_paused(false);
  ASSERT_TRUE((*session)->tick(pose, 0.5));
  EXPECT_EQ((*session)->now_s(), 1.0);
  EXPECT_EQ(told, (std::vector<double>{0.5, 0, 0, 0, 0.5}));
}

TEST(Session, DrawsTheHudOfTheGameOverTheImage) {
  SessionOptions options = short_session();
  options.preset = render::Preset::kLow;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  const auto red = [&] {
    EXPECT_TRUE((*session)->tick((*session)->home(), 0));
    const auto picture = (*session)->picture();
    int count = 0;
    for (std::size_t i = 0; picture && i < picture->rgba.size(); i += 4)
      count += picture->rgba[i] > 200 && picture->rgba[i + 1] < 60 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(red(), 0);
  render::HudText text;
  text.text =
      "Gr\xC3\xBC\xC3\x9F"
      "e";
  text.at = {{0.5F, 0.5F}, {}};
  text.align = render::HudAlign::kCentre;
  text.size_px = 48.5F;
  text.colour = {1, 0, 0, 1};
  text.outline_px = 2;
  (*session)->hud().texts.push_back(text);
  const int letters = red();
  EXPECT_GT(letters, 500);
  EXPECT_LT(letters, 4000);
  (*session)->hud() = {};
  EXPECT_EQ(red(), 0);
  EXPECT_TRUE((*session)->renderer().validation_messages().empty());
}

}  // namespace
}  // namespace psygen::app
