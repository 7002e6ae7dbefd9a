// How many frames a second an application holds, and that it is by the time of its own frames.
#include <algorithm>
#include <functional>

#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::app {
namespace {

double target_frame_ms(const FlightOptions& options) {
  const auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  return flight ? (*flight)->session().scene().state().settings.target_frame_ms : -1.0;
}

TEST(FrameTarget, Is60HzInAWindowNoneHeadlessAndWhateverTheOptionsSay) {
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

// What it was in each frame of a flight.
std::vector<double> errors_of_flight(double target_hz) {
  std::vector<double> errors;
  FlightOptions options = short_flight();
  options.session.target_hz = target_hz;
  options.session.scene.max_error_pixels = 4;
  options.session.scene.max_error_factor = 3;
  options.session.scene.min_resolution = 1;
  options.session.plugins.push_back(
      {.name = "watch", .on_frame = [&errors](Session& session, double) {
         errors.push_back(session.scene().state().quality.error_pixels);
       }});
  auto flight = Flight::create(options);
  EXPECT_TRUE(flight) << flight.error().message;
  if (!flight) return {0};
  EXPECT_TRUE((*flight)->run());
  EXPECT_EQ(errors.size(), options.frames);
  return errors;
}

// No frame takes less than a microsecond, and hardly one more than ten seconds.
TEST(FrameTarget, TheErrorOfAFlightFollowsTheTimeOfItsFrames) {
  for (const double error : errors_of_flight(1e6))
    EXPECT_EQ(error, 12);
  const std::vector<double> errors = errors_of_flight(1.0 / 10);
  EXPECT_EQ(errors.front(), 12);
  EXPECT_TRUE(std::ranges::is_sorted(errors, std::greater{}));
  EXPECT_LT(errors.back(), 9);
  EXPECT_GT(errors.back(), 4);
}

}  // namespace
}  // namespace psygen::app
