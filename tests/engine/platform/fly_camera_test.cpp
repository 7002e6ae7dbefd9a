#include "engine/platform/fly_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <limits>
#include <numbers>

namespace psygen::platform {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

InputState holding(std::initializer_list<Key> keys) {
  InputState input;
  for (const Key key : keys)
    input.held.set(static_cast<std::size_t>(key));
  return input;
}

// The pose after `seconds` in steps of `dt_s`.
core::CameraPose fly(FlyCamera& camera, core::CameraPose pose, const InputState& input,
                     double seconds, double dt_s = 0.01) {
  const int steps = static_cast<int>(std::lround(seconds / dt_s));
  for (int i = 0; i < steps; ++i)
    pose = camera.update(pose, input, dt_s);
  return pose;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(FlyCamera, StandsStillWithoutInput) {
  FlyCamera camera;
  const core::CameraPose pose = fly(camera, {}, {}, 1.0);
  EXPECT_EQ(pose.position.local, glm::dvec3(0.0));
  EXPECT_EQ(pose.yaw, 0.0);
  EXPECT_EQ(pose.pitch, 0.0);
}

TEST(FlyCamera, AcceleratesToItsSpeedAndStopsSmoothly) {
  FlyCamera camera;
  core::CameraPose pose = fly(camera, {}, holding({Key::kW}), 2.0);
  expect_near(camera.velocity_m_s(), {0, 0, -20}, 1e-3);
  EXPECT_NEAR(pose.position.local.z, -20.0 * (2.0 - 0.12), 1e-3);
  const double before = pose.position.local.z;
  pose = camera.update(pose, {}, 0.01);
  EXPECT_LT(pose.position.local.z, before);
  pose = fly(camera, pose, {}, 2.0);
  EXPECT_LT(glm::length(camera.velocity_m_s()), 1e-3);
}

TEST(FlyCamera, EachKeyMovesAlongItsOwnAxisOfTheView) {
  core::CameraPose looking_right;
  looking_right.yaw = std::numbers::pi / 2;
  const std::initializer_list<std::pair<Key, glm::dvec3>> kDirections{
      {Key::kW, {1, 0, 0}},  {Key::kS, {-1, 0, 0}}, {Key::kD, {0, 0, 1}},
      {Key::kA, {0, 0, -1}}, {Key::kE, {0, 1, 0}},  {Key::kQ, {0, -1, 0}}};
  for (const auto& [key, direction] : kDirections) {
    FlyCamera camera;
    const core::CameraPose pose = fly(camera, looking_right, holding({key}), 3.0);
    expect_near(glm::normalize(pose.position.local), direction, 1e-6);
  }
}

TEST(FlyCamera, OppositeKeysCancelAndDiagonalsAreNotFaster) {
  FlyCamera camera;
  fly(camera, {}, holding({Key::kW, Key::kS}), 1.0);
  EXPECT_EQ(glm::length(camera.velocity_m_s()), 0.0);
  fly(camera, {}, holding({Key::kW, Key::kD, Key::kE}), 3.0);
  EXPECT_NEAR(glm::length(camera.velocity_m_s()), 20.0, 1e-3);
}

TEST(FlyCamera, ShiftIsFasterAndControlSlower) {
  FlyCamera camera;
  fly(camera, {}, holding({Key::kW, Key::kShift}), 3.0);
  EXPECT_NEAR(glm::length(camera.velocity_m_s()), 100.0, 1e-2);
  fly(camera, {}, holding({Key::kW, Key::kControl}), 3.0);
  EXPECT_NEAR(glm::length(camera.velocity_m_s()), 4.0, 1e-2);
}

TEST(FlyCamera, ReachesTheSamePositionAtEveryFrameRate) {
  for (const double dt : {0.002, 0.02, 0.1, 0.25}) {
    FlyCamera camera;
    const core::CameraPose pose = fly(camera, {}, holding({Key::kW, Key::kE}), 1.0, dt);
    FlyCamera reference;
    const core::CameraPose expected = fly(reference, {}, holding({Key::kW, Key::kE}), 1.0, 0.01);
    expect_near(pose.position.local, expected.position.local, 1e-9);
  }
}

TEST(FlyCamera, TheWheelChangesTheSpeedWithinItsBounds) {
  FlyCamera camera;
  InputState input;
  input.wheel = 2;
  camera.update({}, input, 0.01);
  EXPECT_NEAR(camera.speed_m_s(), 20.0 * 1.25 * 1.25, 1e-9);
  input.wheel = 1e300;
  camera.update({}, input, 0.01);
  EXPECT_EQ(camera.speed_m_s(), 2000.0);
  for (int i = 0; i < 3; ++i) {
    input.wheel = -100;
    camera.update({}, input, 0.01);
  }
  EXPECT_EQ(camera.speed_m_s(), 0.5);
}

TEST(FlyCamera, MouseAndArrowsTurnTheSameWay) {
  FlyCamera camera;
  InputState mouse;
  mouse.look_px = {100, -40};
  const core::CameraPose turned = camera.update({}, mouse, 0.01);
  EXPECT_NEAR(turned.yaw, 0.25, 1e-12);
  EXPECT_NEAR(turned.pitch, 0.1, 1e-12);
  FlyCamera other;
  const core::CameraPose arrows = fly(other, {}, holding({Key::kRight, Key::kUp}), 0.5);
  EXPECT_GT(arrows.yaw, 0.1);
  EXPECT_GT(arrows.pitch, 0.1);
}

TEST(FlyCamera, PitchStopsBeforeStraightUpAndDown) {
  FlyCamera camera;
  InputState input;
  input.look_px = {0, -1e9};
  EXPECT_EQ(camera.update({}, input, 0.01).pitch, 1.55);
  input.look_px = {0, 1e9};
  EXPECT_EQ(camera.update({}, input, 0.01).pitch, -1.55);
}

TEST(FlyCamera, InputThatIsNotANumberChangesNothing) {
  FlyCamera camera;
  core::CameraPose start;
  start.position.local = {1, 2, 3};
  InputState input = holding({Key::kW});
  input.look_px = {kNaN, std::numeric_limits<double>::infinity()};
  input.wheel = kNaN;
  const core::CameraPose pose = camera.update(start, input, kNaN);
  EXPECT_EQ(pose.position.local, start.position.local);
  EXPECT_EQ(pose.yaw, 0.0);
  EXPECT_EQ(pose.pitch, 0.0);
  EXPECT_EQ(camera.speed_m_s(), 20.0);
  EXPECT_TRUE(core::is_valid(camera.update(pose, input, 0.01)));
}

TEST(FlyCamera, NegativeTimeIsIgnoredAndALongFrameIsClamped) {
  FlyCamera camera;
  EXPECT_EQ(camera.update({}, holding({Key::kW}), -1.0).position.local, glm::dvec3(0.0));
  const core::CameraPose pose = camera.update({}, holding({Key::kW}), 1e9);
  EXPECT_GT(pose.position.local.z, -20.0 * 0.25);
}

TEST(FlyCamera, KeepsTheLastValidPoseAtTheEndOfTheWorld) {
  FlyCamera camera;
  core::CameraPose high;
  high.position.local.y = 1e7;
  const core::CameraPose pose = fly(camera, high, holding({Key::kE}), 1.0);
  EXPECT_TRUE(core::is_valid(pose));
  EXPECT_EQ(pose.position.local.y, 1e7);
  core::CameraPose broken;
  broken.position.local.x = 1e30;
  EXPECT_EQ(camera.update(broken, {}, 0.1).position.local.x, 1e30);
}

TEST(FlyCamera, StopsImmediatelyOnRequest) {
  FlyCamera camera;
  fly(camera, {}, holding({Key::kW, Key::kRight}), 1.0);
  camera.stop();
  const core::CameraPose pose = camera.update({}, {}, 0.1);
  EXPECT_EQ(pose.position.local, glm::dvec3(0.0));
  EXPECT_EQ(pose.yaw, 0.0);
}

}  // namespace
}  // namespace psygen::platform
