#include "engine/app/overlay.hpp"

#include <gtest/gtest.h>

namespace psygen::app {
namespace {

TEST(Overlay, SaysNothingBeforeTheFirstFrameAndTheMedianAfterwards) {
  Overlay overlay;
  scene::State state;
  EXPECT_TRUE(overlay.lines(state, {}).empty());
  for (const double ms : {10.0, 50.0, 20.0})
    overlay.add_frame(ms);
  const auto lines = overlay.lines(state, {});
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines[0].find("50.0 fps"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("50.0 ms worst"), std::string::npos) << lines[0];
}

TEST(Overlay, ShowsWhatIsWaitedAndWhatTheDeviceTakesWhereThatIsKnown) {
  Overlay overlay;
  scene::State state;
  overlay.add_frame(20);
  state.record.device_wait_ms = 12;
  state.record.present_ms = 0.5;
  EXPECT_NE(overlay.lines(state, {})[0].find("waits  12.5 ms"), std::string::npos);
  EXPECT_EQ(overlay.lines(state, {})[0].find("device"), std::string::npos);
  state.counters.frame.gpu = render::GpuTime{1, 0, 17.25, 0};
  EXPECT_NE(overlay.lines(state, {})[0].find("device  17.2 ms"), std::string::npos);
}

}  // namespace
}  // namespace psygen::app
