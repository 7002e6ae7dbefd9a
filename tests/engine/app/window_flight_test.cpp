// Flights in a window with simulated users: the end of a path, the keys, and closing the window
// while it loads.
#include <fstream>
#include <functional>
#include <thread>

#include "engine/render/preset.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/virtual_display.hpp"
#include "tests/engine/scene/gate.hpp"

namespace psygen::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Stops tests that would never end: many more frames than any of them needs.
constexpr std::uint64_t kMaxFrames = 20'000;

class WindowFlight : public ::testing::Test {
 protected:
  void SetUp() override {
    display_ = platform::VirtualDisplay::start();
    ASSERT_NE(display_, nullptr) << "these tests need xvfb, openbox and xdotool";
    std::filesystem::create_directories(folder_);
  }

  // A flight in a window, along a path of half a second at 30 frames a second.
  FlightOptions options() {
    FlightOptions made = short_flight();
    made.session.headless = false;
    made.session.vsync = false;
    made.frames = 0;
    made.session.scene.view_distance_m = 64;
    made.out_folder = folder_;
    made.session.stop = &stop_;
    made.path_file = folder_ / "path.toml";
    std::ofstream(made.path_file) << "format = 1\n[path]\nname = \"short\"\n"
                                  << "origin_block = [256, 256]\n"
                                  << "[[point]]\ntime_s = 0\nat_m = [0, 0]\nheight_m = 9\n"
                                  << "[[point]]\ntime_s = 0.5\nat_m = [5, 0]\nheight_m = 9\n";
    return made;
  }
  bool press(const char* key) {
    return display_->xdotool({"search", "--sync", "--onlyvisible", "--name", "psygen: paper",
                              "windowactivate", "--sync", "key", key});
  }
  static std::string notices(Session& session) {
    std::string text;
    for (const render::TextPanel& panel : session.scene().input().panels) {
      for (const render::TextLine& line : panel.lines)
        if (panel.anchor == render::Anchor::kBottom) text += line.text + "\n";
    }
    return text;
  }

  // An action of the user, and its effect, for which the next action waits. A key is pressed again
  // if the window manager was not ready for it.
  struct Step {
    const char* key;
    std::function<bool(Session&)> done;
  };
  // Flies until all steps are done or too many frames have passed.
  void do_steps(FlightOptions made, std::vector<Step> steps) {
    constexpr std::uint64_t kFramesForAKey = 400;
    std::size_t next = 0;
    std::uint64_t frames = 0, pressed = kFramesForAKey;
    made.session.plugins.push_back({.name = "person", .on_frame = [&](Session& session, double) {
                                      ++frames;
                                      if (next < steps.size() && pressed < kFramesForAKey &&
                                          steps[next].done(session)) {
                                        ++next;
                                        pressed = kFramesForAKey;
                                      }
                                      if (next == steps.size() || frames > kMaxFrames) stop_ = true;
                                      if (!stop_ && pressed++ >= kFramesForAKey) {
                                        EXPECT_TRUE(press(steps[next].key));
                                        pressed = 0;
                                      }
                                    }});
    auto flight = Flight::create(made);
    ASSERT_TRUE(flight) << flight.error().message;
    const auto report = (*flight)->run();
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_THAT(report->validation_messages, IsEmpty());
    EXPECT_EQ(next, steps.size()) << (next < steps.size() ? steps[next].key : "");
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_ / "out";
  std::unique_ptr<platform::VirtualDisplay> display_;
  std::atomic<bool> stop_{false};
};

TEST_F(WindowFlight, TheWindowStaysAfterThePathAndTheReportCoversTheFlight) {
  FlightOptions made = options();
  made.images_every = 10;
  int ends = 0;
  std::uint64_t frames = 0, frames_at_end = 0;
  const Flight* flown = nullptr;
  std::string told;
  made.session.plugins.push_back(
      {.name = "watch",
       .on_frame =
           [&](Session& session, double) {
             ++frames;
             EXPECT_EQ(flown->is_recorded(), ends == 0);
             if (ends > 0) told = notices(session);
             if (frames == frames_at_end + 25) stop_ = true;
           },
       .on_end =
           [&](Session&, const FlightReport& report) {
             ++ends;
             frames_at_end = frames;
             EXPECT_EQ(report.summary.run.frames, 15u);
             for (const char* name :
                  {"frames.csv", "summary.json", "trace.json", "report.html", "frame_00010.png"}) {
               EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
             }
           }});
  const auto flight = Flight::create(made);
  ASSERT_TRUE(flight) << flight.error().message;
  flown = flight->get();
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(ends, 1);
  EXPECT_EQ(frames_at_end, 15u);
  EXPECT_EQ(frames, 40u);
  EXPECT_EQ(report->summary.run.frames, 15u);
  EXPECT_THAT(told, HasSubstr("The flight has ended after 0.5 s and 15 frames"));
  EXPECT_THAT(told, HasSubstr("report.html"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "frame_00020.png"));
  EXPECT_THAT(report->validation_messages, IsEmpty());
}

TEST_F(WindowFlight, TheWindowClosesAfterTheGivenSecondsOrFrames) {
  for (const bool seconds : {true, false}) {
    FlightOptions made = options();
    made.seconds = seconds ? 0.2 : 0;
    made.frames = seconds ? 0 : 6;
    const auto flight = Flight::create(made);
    ASSERT_TRUE(flight) << flight.error().message;
    const auto report = (*flight)->run();
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->summary.run.frames, 6u);
  }
}

TEST_F(WindowFlight, OutputErrorsAreShownInTheWindowAndInTheReport) {
  FlightOptions made = options();
  std::string told;
  std::uint64_t frames = 0;
  made.session.plugins.push_back({.name = "watch", .on_frame = [&](Session& session, double) {
                                    if (++frames == 5) {  // blocks the path of a file
                                      std::filesystem::create_directories(folder_ / "frames.csv");
                                    }
                                    if (frames == 20) {
                                      told = notices(session);
                                      stop_ = true;
                                    }
                                  }});
  const auto flight = Flight::create(made);
  ASSERT_TRUE(flight) << flight.error().message;
  const auto report = (*flight)->run();
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->failures.size(), 1u);
  EXPECT_EQ(report->failures[0].code, core::ErrorCode::kIo);
  EXPECT_THAT(report->failures[0].message, HasSubstr("frames.csv"));
  EXPECT_THAT(told, HasSubstr("frames.csv"));
}

TEST_F(WindowFlight, ItsKeysMatchTheHelp) {
  const auto view_is = [](render::View view) {
    return [view](Session& session) { return session.scene().input().view == view; };
  };
  const auto text_has = [](render::Anchor anchor, const char* words) {
    return [=](Session& session) {
      for (const render::TextPanel& panel : session.scene().input().panels) {
        for (const render::TextLine& line : panel.lines)
          if (panel.anchor == anchor && line.text.find(words) != std::string::npos) return true;
      }
      return false;
    };
  };
  const auto preset_is = [](render::Preset preset) {
    return [preset](Session& session) {
      return session.renderer().preset() == preset &&
             session.scene().facts().shadows == session.renderer().casts_shadows() &&
             session.scene().facts().near_detail == session.renderer().has_near_models();
    };
  };
  const auto size_is = [](core::Extent size) {
    return [size](Session& session) { return session.renderer().size() == size; };
  };
  using render::Anchor;
  FlightOptions made = options();
  made.session.preset = render::Preset::kMedium;
  do_steps(made,
           {{"F1", text_has(Anchor::kTopLeft, "full screen")},
            {"F1", [](Session& session) { return session.scene().input().panels.size() == 2; }},
            {"F1", text_has(Anchor::kTopLeft, "preset medium")},
            {"F2", view_is(render::View::kLevels)},
            {"F2", view_is(render::View::kLayers)},
            {"F2", text_has(Anchor::kTopRight, "view: bounds")},
            {"F11", size_is({1280, 1024})},
            {"F11", size_is({320, 180})},
            {"p", [](Session& session) { return session.paused(); }},
            {"p", [](Session& session) { return !session.paused(); }},
            {"F12", text_has(Anchor::kBottom, "screenshot_0000.png")},
            {"F3", preset_is(render::Preset::kHigh)},
            {"F1", text_has(Anchor::kBottom, "preset high")}});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "screenshot_0000.png"));
}

TEST_F(WindowFlight, AScreenshotErrorIsShownOnTheScreen) {
  const std::filesystem::path moved = folder_.string() + "_moved";
  FlightOptions made = options();
  made.session.plugins.push_back(
      {.name = "mover", .on_start = [&](Session&) { std::filesystem::rename(folder_, moved); }});
  do_steps(made, {{"F12", [&](Session& session) {
                     const bool told = notices(session).starts_with("cannot save the screenshot: ");
                     if (told) std::filesystem::rename(moved, folder_);
                     return told;
                   }}});
}

TEST_F(WindowFlight, ClosingWhileTheCacheIsFilledEndsAtOnceWithoutAFlight) {
  scene::Gate gate(true);  // the thread that waits makes no rock either
  FlightOptions made = options();
  made.session.scene.virtual_time = false;  // modelers are real threads and wait at the gate
  made.session.scene.watchdog_seconds = 1e6;
  made.session.world_file = folder_ / "slow.toml";
  std::ofstream(made.session.world_file)
      << "format = 1\n[world]\nname = \"paper\"\nseed = 1\n"
      << "blocks = [512, 512]\n[[scatter]]\nmodel = \"slow_rock\"\n"
      << "count = 40\n";
  models::Registry standard = models::make_standard_registry();
  const auto rock = static_cast<models::ModelIndex>(standard.find("rock"));
  made.session.plugins.push_back(
      {.name = "slow",
       .register_models = [&](models::Registry& registry) -> core::Result<void> {
         const auto added =
             registry.add(std::make_unique<scene::SlowType>("slow_rock", standard[rock], gate));
         if (!added) return tl::unexpected(added.error());
         return {};
       },
       .on_start = [](Session&) { ADD_FAILURE() << "the flight began"; }});
  auto flight = Flight::create(made);
  ASSERT_TRUE(flight) << flight.error().message;
  gate.set_open(false);  // from here on no mesh is finished
  std::atomic<bool> ended{false};
  std::thread person([&] {
    while (!ended)
      press("alt+F4");
  });
  const auto report = (*flight)->run();
  ended = true;
  person.join();
  gate.set_open(true);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, core::ErrorCode::kInterrupted);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "summary.json"));
}

}  // namespace
}  // namespace psygen::app
