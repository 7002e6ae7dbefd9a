#include "engine/visibility/camera_predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace psygen::visibility {
namespace {

constexpr double kOddBlock_m = 63;
constexpr double kPi = std::numbers::pi;

core::CameraPose pose_at(core::BlockCoord block, glm::dvec3 local, double yaw = 0,
                         double pitch = 0) {
  return {core::normalised({block, local}, kOddBlock_m), yaw, pitch};
}

// Metres between two poses.
double gap_m(const core::CameraPose& a, const core::CameraPose& b) {
  return glm::length(core::offset_m(b.position.block, a.position, kOddBlock_m) + b.position.local);
}

// Flies 2 s at 60 Hz along +X with 50 m/s, turning at `yaw_rate`.
CameraPredictor flown(core::BlockCoord from, double yaw_rate) {
  CameraPredictor predictor;
  for (int i = 0; i <= 120; ++i) {
    const double t = i / 60.0;
    predictor.observe(t, pose_at(from, {50 * t, 10, 5}, yaw_rate * t), kOddBlock_m);
  }
  return predictor;
}

TEST(CameraPredictor, PredictsAConstantFlightExactly) {
  const core::CameraPose predicted = flown({3, -4}, 0.5).predict(1.5);
  const core::CameraPose expected = pose_at({3, -4}, {50 * 3.5, 10, 5});
  EXPECT_NEAR(gap_m(predicted, expected), 0, 1e-6);
  EXPECT_NEAR(predicted.yaw, 0.5 * 3.5, 1e-9);
}

TEST(CameraPredictor, IsAsExactFarFromTheOriginAndAcrossTheSeamOfTheIndices) {
  const core::BlockCoord far{INT32_MAX, INT32_MIN};
  const core::CameraPose predicted = flown(far, 0).predict(1.5);
  EXPECT_NEAR(gap_m(predicted, pose_at(far, {50 * 3.5, 10, 5})), 0, 1e-6);
  EXPECT_LT(predicted.position.block.x, 0);
}

TEST(CameraPredictor, PredictedPositionsAreNormalised) {
  const core::CameraPose predicted = flown({0, 0}, 0).predict(5);
  EXPECT_GE(predicted.position.local.x, 0);
  EXPECT_LT(predicted.position.local.x, kOddBlock_m);
}

TEST(CameraPredictor, WithoutMovementNothingMoves) {
  CameraPredictor predictor;
  const core::CameraPose pose = pose_at({1, 1}, {1, 2, 3}, 0.4, -0.2);
  predictor.observe(0, pose, kOddBlock_m);
  EXPECT_NEAR(gap_m(predictor.predict(3), pose), 0, 1e-12);
  predictor.observe(1, pose, kOddBlock_m);
  EXPECT_NEAR(gap_m(predictor.predict(3), pose), 0, 1e-12);
  EXPECT_DOUBLE_EQ(predictor.predict(3).yaw, 0.4);
}

TEST(CameraPredictor, ATurnAcrossTheBackTakesTheShortWay) {
  CameraPredictor predictor;
  predictor.observe(0.0, pose_at({}, {}, kPi - 0.01), kOddBlock_m);
  predictor.observe(0.1, pose_at({}, {}, -kPi + 0.01), kOddBlock_m);
  EXPECT_NEAR(predictor.yaw_rate(), 0.2, 1e-9);
}

TEST(CameraPredictor, AChangeOfVelocityIsBelievedGradually) {
  CameraPredictor predictor = flown({0, 0}, 0);
  const double before = predictor.velocity_m_s().x;
  predictor.observe(2.05, pose_at({0, 0}, {100, 10, 5}), kOddBlock_m);  // stopped at once
  EXPECT_LT(predictor.velocity_m_s().x, before);
  EXPECT_GT(predictor.velocity_m_s().x, before * 0.5);
  for (int i = 1; i <= 30; ++i)
    predictor.observe(2.05 + i * 0.05, pose_at({0, 0}, {100, 10, 5}), kOddBlock_m);
  EXPECT_NEAR(predictor.velocity_m_s().x, 0, 0.1);
}

TEST(CameraPredictor, ATeleportStartsAfresh) {
  CameraPredictor predictor = flown({0, 0}, 0.5);
  const core::CameraPose elsewhere = pose_at({5000, 9}, {1, 2, 3}, 1);
  predictor.observe(2.02, elsewhere, kOddBlock_m);
  EXPECT_EQ(predictor.velocity_m_s(), glm::dvec3(0.0));
  EXPECT_DOUBLE_EQ(predictor.yaw_rate(), 0);
  EXPECT_NEAR(gap_m(predictor.predict(3), elsewhere), 0, 1e-9);
}

TEST(CameraPredictor, PredictionsAreBounded) {
  CameraPredictor predictor;
  for (int i = 0; i < 40; ++i)
    predictor.observe(i * 0.01, pose_at({}, {19.0 * i, 0, 0}, i * 0.2, i * 0.02), kOddBlock_m);
  const core::CameraPose now = predictor.predict(0), late = predictor.predict(1e9);
  EXPECT_LE(gap_m(now, late),
            CameraPredictor::kMaxSpeed_m_s * CameraPredictor::kMaxPrediction_s + 1e-6);
  EXPECT_LE(std::abs(late.yaw - now.yaw), kPi + 1e-9);
  EXPECT_LE(std::abs(late.pitch), kPi / 2);
  EXPECT_TRUE(core::is_valid(late));
}

TEST(CameraPredictor, InvalidPosesAndTimesAreIgnored) {
  CameraPredictor predictor = flown({0, 0}, 0);
  const core::CameraPose before = predictor.predict(1);
  core::CameraPose bad;
  bad.yaw = std::numeric_limits<double>::quiet_NaN();
  predictor.observe(2.1, bad, kOddBlock_m);
  bad.yaw = 0;
  bad.position.local.y = 1e30;
  predictor.observe(2.1, bad, kOddBlock_m);
  predictor.observe(std::numeric_limits<double>::infinity(), {}, kOddBlock_m);
  EXPECT_EQ(gap_m(predictor.predict(1), before), 0);
}

TEST(CameraPredictor, ATimeThatDoesNotGrowDoesNotDivideByZero) {
  CameraPredictor predictor = flown({0, 0}, 0);
  predictor.observe(2.0, pose_at({0, 0}, {101, 10, 5}), kOddBlock_m);
  EXPECT_NEAR(predictor.velocity_m_s().x, 50, 1e-6);
  predictor.observe(0.5, pose_at({0, 0}, {102, 10, 5}), kOddBlock_m);  // the clock went back
  EXPECT_EQ(predictor.velocity_m_s(), glm::dvec3(0.0));
}

}  // namespace
}  // namespace psygen::visibility
