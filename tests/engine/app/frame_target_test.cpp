// How many frames a second an application holds, and that it is by the time of its own frames.
#include <algorithm>
#include <functional>

#include "tests/engine/app/fixture.hpp"
#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::app {
namespace {

double target_frame_ms(const Options& options) {
  const auto app = App::create(options);
  EXPECT_TRUE(app) << app.error().message;
  return app ? (*app)->scene().state().settings.target_frame_ms : -1.0;
}

TEST(FrameTarget, Is60HzInAWindowNoneHeadlessAndWhateverTheOptionsSay) {
  Options options = short_flight();
  EXPECT_EQ(target_frame_ms(options), 0);
  options.target_hz = 90;
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 90);
  const auto display = platform::VirtualDisplay::start();
  ASSERT_NE(display, nullptr) << "this test needs xvfb, openbox and xdotool";
  options.headless = false;
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 90);
  options.target_hz = 0;
  EXPECT_EQ(target_frame_ms(options), 0);
  options.target_hz.reset();
  EXPECT_DOUBLE_EQ(target_frame_ms(options), 1000.0 / 60);
}

// What it was in each frame of a flight.
std::vector<double> errors_of_flight(double target_hz) {
  std::vector<double> errors;
  Options options = short_flight();
  options.target_hz = target_hz;
  options.scene.max_error_pixels = 4;
  options.scene.max_error_factor = 3;
  options.plugins.push_back({"watch", {}, {}, [&errors](App& app, double) {
                               errors.push_back(app.scene().state().quality.error_pixels);
                             }});
  auto app = App::create(options);
  EXPECT_TRUE(app) << app.error().message;
  if (!app) return {0};
  EXPECT_TRUE((*app)->run());
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
