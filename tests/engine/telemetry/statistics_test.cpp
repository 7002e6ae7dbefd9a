#include "engine/telemetry/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/core/hash.hpp"

namespace psygen::telemetry {
namespace {

std::vector<double> counted(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST(Percentile, InterpolatesLinearlyAtPTimesNMinusOne) {
  EXPECT_DOUBLE_EQ(*percentile(std::vector{1.0, 2.0}, 0.5), 1.5);
  EXPECT_DOUBLE_EQ(*percentile(std::vector{4.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(*percentile(counted(101), 0.95), 96.0);
  EXPECT_NEAR(*percentile(counted(100), 0.99), 1.0 + 0.99 * 99.0, 1e-12);
  EXPECT_DOUBLE_EQ(*percentile(std::vector{3.0, 7.0}, 0.0), 3.0);
  EXPECT_DOUBLE_EQ(*percentile(std::vector{3.0, 7.0}, 1.0), 7.0);
}

TEST(Percentile, DoesNotDependOnTheOrderOfTheValues) {
  std::vector<double> values = counted(1000);
  std::vector<double> mixed = values;
  std::sort(mixed.begin(), mixed.end(), [](double a, double b) {
    return core::mix64(static_cast<std::uint64_t>(a)) < core::mix64(static_cast<std::uint64_t>(b));
  });
  for (const double p : {0.0, 0.25, 0.5, 0.95, 0.99, 0.999, 1.0})
    EXPECT_EQ(percentile(values, p), percentile(mixed, p));
}

TEST(Percentile, IsMissingWithAReasonIfNoValueCouldLieAboveIt) {
  EXPECT_FALSE(percentile(counted(99), 0.99).has_value());
  EXPECT_TRUE(percentile(counted(100), 0.99).has_value());
  EXPECT_FALSE(percentile(counted(19), 0.95).has_value());
  EXPECT_TRUE(percentile(counted(20), 0.95).has_value());
  EXPECT_EQ(percentile(counted(999), 0.999).reason, "needs at least 1000 values, there are 999");
  EXPECT_EQ(percentile(counted(1), 0.5).reason, "needs at least 2 values, there is 1");
  EXPECT_EQ(percentile({}, 1.0).reason, "needs at least 1 value, there are 0");
}

TEST(Mean, AndLargestAreMissingWithoutValues) {
  EXPECT_DOUBLE_EQ(*mean(std::vector{1.0, 2.0, 6.0}), 3.0);
  EXPECT_DOUBLE_EQ(*largest(std::vector{1.0, 6.0, 2.0}), 6.0);
  EXPECT_FALSE(mean({}).has_value());
  EXPECT_FALSE(largest({}).has_value());
}

TEST(Low1Fps, IsAThousandDividedByTheMeanOfFramesFromP99On) {
  std::vector<double> frames(200, 10.0);
  frames[17] = 40.0;
  frames[90] = 60.0;
  frames[91] = 50.0;
  // h = 0.99 · 199 = 197.01: between 40 and 50, so that the frames of 50 and 60 ms count.
  EXPECT_NEAR(*low1_fps(frames), 1000.0 / 55.0, 1e-9);
}

TEST(Low1Fps, CountsFramesEqualToP99) {
  EXPECT_DOUBLE_EQ(*low1_fps(std::vector<double>(100, 20.0)), 50.0);
}

TEST(Low1Fps, IsMissingBelowAHundredFrames) {
  EXPECT_FALSE(low1_fps(std::vector<double>(99, 20.0)).has_value());
}

TEST(Hitches, CountFramesOver60MsAndOver1Point5TimesThePrevious) {
  EXPECT_EQ(*hitches(std::vector{20.0, 61.0}), 1U);
  EXPECT_EQ(*hitches(std::vector{20.0, 60.0}), 0U);
  EXPECT_EQ(*hitches(std::vector{50.0, 75.0}), 0U);
  EXPECT_EQ(*hitches(std::vector{50.0, 75.1}), 1U);
  EXPECT_EQ(*hitches(std::vector{20.0, 61.0, 61.0, 61.0}), 1U);
}

TEST(Hitches, AreAtLeast200MsApart) {
  std::vector<double> frames{10.0, 100.0};
  frames.insert(frames.end(), 9, 10.0);
  frames.push_back(100.0);  // ends 190 ms after the first
  EXPECT_EQ(*hitches(frames), 1U);
  frames.insert(frames.begin() + 2, 10.0);
  EXPECT_EQ(*hitches(frames), 2U);
}

TEST(Hitches, CannotBeTheFirstFrameAndNeedTwo) {
  EXPECT_EQ(*hitches(std::vector{500.0, 10.0}), 0U);
  EXPECT_FALSE(hitches(std::vector{500.0}).has_value());
}

TEST(StutterPercent, IsTheFractionOfTimeInFramesOver2Point5TimesTheMovingAverage) {
  EXPECT_DOUBLE_EQ(*stutter_percent(std::vector<double>(100, 10.0)), 0.0);
  std::vector<double> frames(100, 10.0);
  frames[50] = 25.0;
  EXPECT_DOUBLE_EQ(*stutter_percent(frames), 0.0);
  frames[50] = 26.0;
  EXPECT_DOUBLE_EQ(*stutter_percent(frames), 100.0 * 26.0 / (99.0 * 10.0 + 26.0));
}

TEST(StutterPercent, AveragesOverThe60PreviousFrames) {
  std::vector<double> frames(61, 10.0);
  frames[0] = 1000.0;
  frames.push_back(26.0);
  // The frame of 1000 ms is 61 frames before the last one and no longer part of the average.
  EXPECT_GT(*stutter_percent(frames), 0.0);
  frames.erase(frames.begin() + 1);
  EXPECT_DOUBLE_EQ(*stutter_percent(frames), 0.0);
}

TEST(Statistics, OfFramesWithoutTimeAreMissingInsteadOfNotANumber) {
  const std::vector<double> nothing(200, 0.0);
  EXPECT_FALSE(low1_fps(nothing).has_value());
  EXPECT_FALSE(stutter_percent(nothing).has_value());
}

TEST(Low01Fps, IsTheRateOfTheSlowestThousandth) {
  std::vector<double> ms(2000, 10);
  ms[700] = 40;
  ms[900] = 60;  // p99.9 lies between 10 and 40 ms
  EXPECT_NEAR(*low01_fps(ms), 1000.0 / 50, 1e-9);
  ms.resize(999);
  EXPECT_EQ(low01_fps(ms).reason, "needs at least 1000 values, there are 999");
}

}  // namespace
}  // namespace psygen::telemetry
