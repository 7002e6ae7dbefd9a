#include <gtest/gtest.h>

#include "engine/core/hash.hpp"
#include "engine/synthesis/cost_fit.hpp"

namespace psygen::synthesis {
namespace {

TEST(CostCorrection, AWarmLevelLearnsAFactorAndToleratesOutliers) {
  CostCorrection correction;
  ColdSeconds shared;
  for (int i = 0; i < 400; ++i)
    correction.observe(10e-6, Warmth::kWarm, i % 20 == 7 ? 5e-3 : 15e-6, shared);
  EXPECT_NEAR(correction.seconds(10e-6, Warmth::kWarm, shared), 15e-6, 2e-6);
  EXPECT_NEAR(correction.seconds(40e-6, Warmth::kWarm, shared), 60e-6, 8e-6);
}

TEST(CostCorrection, OneObservationHasLittleWeightAgainstAMeasuredCurve) {
  CostCorrection measured, guessed;
  ColdSeconds shared;
  measured.trust_curve();
  for (CostCorrection* correction : {&measured, &guessed})
    correction->observe(10e-6, Warmth::kWarm, 1.0, shared);
  EXPECT_LT(measured.factor(), 1.1);
  EXPECT_GT(guessed.factor(), 1.3);
}

TEST(CostCorrection, ColdCachesAddTimeWithoutChangingWarmPredictions) {
  CostCorrection correction;
  ColdSeconds shared;
  for (int i = 0; i < 200; ++i) {
    correction.observe(2e-6, Warmth::kWarm, 2e-6, shared);
    correction.observe(2e-6, Warmth::kCold, 6e-6, shared);
    correction.observe(2e-6, Warmth::kAfterSleep, 20e-6, shared);
  }
  EXPECT_NEAR(correction.seconds(2e-6, Warmth::kWarm, shared), 2e-6, 1e-9);
  EXPECT_NEAR(correction.seconds(2e-6, Warmth::kCold, shared), 6e-6, 0.5e-6);
  EXPECT_NEAR(correction.seconds(2e-6, Warmth::kAfterSleep, shared), 20e-6, 1e-6);
  EXPECT_NEAR(correction.seconds(9e-6, Warmth::kCold, shared), 13e-6, 0.5e-6) << "added";
}

// If calibration had no time for a level, its curve is a guess that may be wrong by a factor of a
// thousand, and the ground of a node is seldom synthesised twice in a row.
TEST(CostCorrection, AGuessThatIsFarTooHighIsCorrectedWithoutWarmRequests) {
  CostCorrection correction;
  ColdSeconds shared;
  for (int i = 0; i < 10; ++i)
    correction.observe(100e-3, Warmth::kAfterSleep, 90e-6, shared);
  EXPECT_LT(correction.seconds(100e-3, Warmth::kAfterSleep, shared), 300e-6);
  for (int i = 0; i < 100; ++i)
    correction.observe(100e-3, Warmth::kAfterSleep, 90e-6, shared);
  EXPECT_NEAR(correction.seconds(100e-3, Warmth::kAfterSleep, shared), 90e-6, 9e-6);
}

TEST(CostCorrection, TheSlowFirstRequestOfAThreadIsSoonForgotten) {
  CostCorrection correction;
  ColdSeconds shared;
  correction.observe(2e-6, Warmth::kAfterSleep, 5e-3, shared);
  EXPECT_LT(correction.seconds(2e-6, Warmth::kAfterSleep, shared), 25e-6);
  for (int i = 0; i < 10; ++i)
    correction.observe(2e-6, Warmth::kAfterSleep, 8e-6, shared);
  EXPECT_NEAR(correction.seconds(2e-6, Warmth::kAfterSleep, shared), 8e-6, 4e-6);
}

TEST(CostCorrection, ALevelWithoutColdRequestsBorrowsFromOthersWithTheSameCode) {
  CostCorrection known, unknown;
  ColdSeconds shared;
  for (int i = 0; i < 50; ++i)
    known.observe(2e-6, Warmth::kCold, 7e-6, shared);
  EXPECT_NEAR(unknown.seconds(1e-6, Warmth::kCold, shared), 6e-6, 0.5e-6);
  EXPECT_EQ(unknown.seconds(1e-6, Warmth::kAfterSleep, shared), 1e-6) << "no observation yet";
  for (int i = 0; i < 50; ++i)
    unknown.observe(1e-6, Warmth::kCold, 2e-6, shared);
  EXPECT_NEAR(unknown.seconds(1e-6, Warmth::kCold, shared), 2e-6, 0.5e-6) << "its own estimate";
}

// The estimate follows the median of the observations although one of ten is far off: half of the
// errors are positive.
TEST(RunningEstimate, StayNearTheMedianOfNoisyObservations) {
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  RunningEstimate learned;
  for (int i = 0; i < 2000; ++i) {
    const double usual = random.next_real(8e-6, 12e-6);
    learned.observe(i % 10 == 0 ? 20 * usual : usual, 3e-6);
  }
  EXPECT_GT(learned.value(), 8e-6);
  EXPECT_LT(learned.value(), 13e-6);
  for (int i = 0; i < 100; ++i)
    learned.observe(-1e-6, 3e-6);
  EXPECT_GE(learned.value(), 0);
}

}  // namespace
}  // namespace psygen::synthesis
