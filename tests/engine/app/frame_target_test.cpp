// The target frame rate of an application, and its dependence on the time of the application's
// frames.
#include <algorithm>
#include <functional>

#include "engine/scene/frame/quality.hpp"
#include "engine/scene/settings.hpp"
#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::app {
namespace {

double target_frame_ms(const FlightOptions& options) {
  const auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  return flight ? (*flight)->session().scene().settings().target_frame_ms : -1.0;
}

TEST(FrameTarget, Is60HzInAWindowNoneHeadlessOrAsTheOptionsSay) {
  FlightOptions options = short_flight();
  EXPECT_EQ(target_frame_ms(options), 0);
  options.session.target_hz = 90;
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 90);
  const auto display = platform::VirtualDisplay::start();
  ASSERT_NE(display, nullptr) << "this test needs xvfb, openbox and xdotool";
  options.session.headless = false;
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 90);
  options.session.target_hz = 0;
  EXPECT_EQ(target_frame_ms(options), 0);
  options.session.target_hz.reset();
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 60);
}

FlightOptions governed(double target_hz) {
  FlightOptions options = short_flight();
  options.frames = 60;
  options.session.target_hz = target_hz;
  options.session.scene.max_error_pixels = 4;
  options.session.scene.max_error_factor = 3;
  options.session.scene.min_resolution = 0.5;
  return options;
}

// Coarseness of the images: the error relative to full resolution.
using Watched = std::vector<double>;
double coarseness(Session& session) {
  const scene::Quality& quality = session.scene().quality();
  return quality.error_pixels / quality.resolution;
}

Watched flight(double target_hz) {
  Watched seen;
  FlightOptions options = governed(target_hz);
  options.session.plugins.push_back({.name = "watch", .on_frame = [&](Session& session, double) {
                                       seen.push_back(coarseness(session));
                                     }});
  auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  if (!flight) return {0};
  EXPECT_TRUE((*flight)->run());
  EXPECT_EQ(seen.size(), options.frames);
  return seen;
}

// A game with its own loop.
Watched game(double target_hz) {
  Watched seen;
  const FlightOptions options = governed(target_hz);
  auto session = Session::create(options.session);
  EXPECT_TRUE(session) << session.error().message;
  if (!session) return {0};
  for (std::uint64_t i = 0; i < options.frames; ++i) {
    EXPECT_TRUE((*session)->tick((*session)->home(), 1e-3));
    seen.push_back(coarseness(**session));
  }
  return seen;
}

// Every frame takes more than a microsecond and, practically always, less than ten seconds.
TEST(FrameTarget, TheDetailOfFlightsAndGamesFollowsTheTimeOfTheirFrames) {
  for (const auto& fly : {flight, game}) {
    const Watched slow = fly(1e6), fast = fly(0.1);
    EXPECT_EQ(slow.front(), 8);  // a software device starts with a lower resolution
    EXPECT_EQ(slow.back(), 24);
    EXPECT_TRUE(std::ranges::is_sorted(slow));
    EXPECT_EQ(fast.front(), 8);
    EXPECT_EQ(fast.back(), 4);
    EXPECT_TRUE(std::ranges::is_sorted(fast, std::greater{}));
  }
}

}  // namespace
}  // namespace psygen::app
