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

}  // namespace
}  // namespace psygen::app
