#include "engine/world/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace psygen::world {
namespace {

const std::vector<double> kTimes{0, 1, 1.5, 4, 6};
const std::vector<double> kValues{2, -1, 3, 3, 0.5};

TEST(Spline, GoesThroughItsPoints) {
  const Spline spline(kTimes, kValues);
  for (std::size_t i = 0; i < kTimes.size(); ++i)
    EXPECT_NEAR(spline.value(kTimes[i]), kValues[i], 1e-12);
}

TEST(Spline, ValueSlopeAndBendAreContinuous) {
  const Spline spline(kTimes, kValues);
  constexpr double h = 1e-4;
  for (const double t : {1.0, 1.5, 4.0}) {
    EXPECT_NEAR(spline.value(t - 1e-9), spline.value(t + 1e-9), 1e-7);
    EXPECT_NEAR(spline.slope(t - 1e-9), spline.slope(t + 1e-9), 1e-6);
    const double before = (spline.slope(t - h) - spline.slope(t - 2 * h)) / h;
    const double after = (spline.slope(t + 2 * h) - spline.slope(t + h)) / h;
    EXPECT_NEAR(before, after, 0.02);
  }
}

TEST(Spline, TheSlopeIsTheDerivative) {
  const Spline spline(kTimes, kValues);
  for (double t = 0.05; t < 5.95; t += 0.1)
    EXPECT_NEAR(spline.slope(t), (spline.value(t + 1e-6) - spline.value(t - 1e-6)) / 2e-6, 1e-4);
}

TEST(Spline, ALineStaysALine) {
  const Spline spline(std::vector<double>{0, 1, 5, 6}, std::vector<double>{1, 3, 11, 13});
  for (double t = 0; t <= 6; t += 0.25) {
    EXPECT_NEAR(spline.value(t), 1 + 2 * t, 1e-12);
    EXPECT_NEAR(spline.slope(t), 2, 1e-12);
  }
}

TEST(Spline, HoldsItsEnds) {
  const Spline spline(kTimes, kValues);
  EXPECT_EQ(spline.value(-5), 2);
  EXPECT_EQ(spline.value(60), 0.5);
  EXPECT_EQ(spline.value(std::numeric_limits<double>::quiet_NaN()), 2);
  EXPECT_EQ(spline.slope(-5), 0);
  EXPECT_EQ(spline.slope(60), 0);
}

TEST(Spline, OnePointIsAConstantAndTwoAreALine) {
  const Spline one(std::vector<double>{3}, std::vector<double>{7});
  EXPECT_EQ(one.value(0), 7);
  EXPECT_EQ(one.value(3), 7);
  EXPECT_EQ(one.value(9), 7);
  EXPECT_EQ(one.slope(3), 0);
  const Spline two(std::vector<double>{0, 2}, std::vector<double>{1, 5});
  EXPECT_NEAR(two.value(0.5), 2, 1e-12);
  EXPECT_NEAR(two.slope(2), 2, 1e-12);
}

}  // namespace
}  // namespace psygen::world
