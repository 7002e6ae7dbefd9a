#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {
namespace {

TEST(SampleSet, KeepsEverySampleUpToItsCapacity) {
  SampleSet samples(10);
  for (int i = 0; i < 10; ++i)
    samples.add(i, i * 2.0);
  EXPECT_EQ(samples.values_since(0).size(), 10U);
  EXPECT_EQ(samples.values_since(8), (std::vector{16.0, 18.0}));
  EXPECT_TRUE(samples.values_since(9.5).empty());
}

TEST(SampleSet, KeepsAUniformChoiceBeyondItsCapacity) {
  SampleSet samples(2000);
  for (int i = 0; i < 100'000; ++i)
    samples.add(i, i);
  EXPECT_EQ(samples.added_count(), 100'000U);
  const std::vector<double> values = samples.values_since(0);
  EXPECT_LE(values.size(), 2001U);
  EXPECT_NEAR(*percentile(values, 0.5), 50'000, 4'000);
  EXPECT_NEAR(*percentile(values, 0.05), 5'000, 2'000);
  EXPECT_NEAR(*percentile(values, 0.95), 95'000, 2'000);
}

TEST(SampleSet, NeverLosesTheLargestSample) {
  SampleSet samples(10);
  for (int i = 0; i < 10'000; ++i)
    samples.add(i, i == 20 ? 1e9 : i);
  const std::vector<double> values = samples.values_since(0);
  EXPECT_EQ(*std::max_element(values.begin(), values.end()), 1e9);
  const std::vector<double> later = samples.values_since(21);
  EXPECT_TRUE(std::find(later.begin(), later.end(), 1e9) == later.end());
}

TEST(SampleSet, IgnoresNonFiniteValues) {
  SampleSet samples(10);
  samples.add(0, std::numeric_limits<double>::quiet_NaN());
  samples.add(std::numeric_limits<double>::infinity(), 1);
  EXPECT_EQ(samples.added_count(), 0U);
  EXPECT_TRUE(samples.values_since(0).empty());
}

}  // namespace
}  // namespace psygen::telemetry
