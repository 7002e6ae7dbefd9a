#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/frame/quality.hpp"

namespace psygen::scene {
namespace {

TEST(FrameTimeFit, ExpectsNothingBeforeTheFirstFrame) {
  const FrameTimeFit line;
  EXPECT_TRUE(std::isinf(line.triangles(10)));
}

TEST(FrameTimeFit, FindsTheLineThroughNoisyFrames) {
  FrameTimeFit line;
  for (int i = 0; i < 600; ++i) {
    const double triangles = 50'000 + 30'000 * std::sin(i * 0.05);
    line.observe(6 + triangles * 1.5e-4 + (i % 2 == 0 ? 3 : -3), triangles);
  }
  EXPECT_NEAR(line.triangles(21), 100'000, 7000);
  EXPECT_NEAR(line.triangles(9), 20'000, 7000);
  EXPECT_EQ(line.triangles(1), 0);
}

TEST(FrameTimeFit, HasNoSlopeWhileTrianglesHardlyChange) {
  FrameTimeFit line;
  for (int i = 0; i < 600; ++i)
    line.observe(10 + i % 2, 20'000 + i % 2);
  EXPECT_GT(line.triangles(20), 1e6);
}

TEST(FrameTimeFit, AllowsAnyTriangleCountThatMakesNoDifference) {
  FrameTimeFit line;
  for (int i = 0; i < 600; ++i)
    line.observe(30 - 1e-4 * (i % 100) * 1000, (i % 100) * 1000);  // less with more of them
  EXPECT_TRUE(std::isinf(line.triangles(16)));
}

TEST(FrameTimeFit, ForgetsOldFrames) {
  FrameTimeFit line;
  const auto fly = [&line](int frames, double ms_each) {
    for (int i = 0; i < frames; ++i) {
      const double triangles = 50'000 + 30'000 * std::sin(i * 0.05);
      line.observe(triangles * ms_each, triangles);
    }
  };
  fly(600, 4e-4);
  fly(1200, 1e-4);
  EXPECT_NEAR(line.triangles(5), 50'000, 2000);
}

}  // namespace
}  // namespace psygen::scene
