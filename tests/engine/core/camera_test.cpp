#include "engine/core/camera.hpp"

#include <gtest/gtest.h>

#include <glm/vec4.hpp>
#include <limits>

namespace psygen::core {
namespace {

glm::vec4 project(const CameraPose& pose, glm::vec3 relative) {
  return projection_matrix({}) * view_rotation(pose) * glm::vec4(relative, 1.0F);
}

TEST(Camera, LooksAlongMinusZAtYawZeroAndToPlusXAfterAQuarterTurn) {
  CameraPose pose;
  EXPECT_NEAR(forward_of(pose).z, -1.0F, 1e-6F);
  pose.yaw = 1.5707963267948966;
  EXPECT_NEAR(forward_of(pose).x, 1.0F, 1e-6F);
}

TEST(Camera, ProjectsAPointAheadToTheMiddleWithVulkansRightAndUp) {
  CameraPose pose;
  pose.yaw = 0.7;
  pose.pitch = -0.3;
  const glm::vec4 ahead = project(pose, forward_of(pose) * 10.0F);
  EXPECT_NEAR(ahead.x / ahead.w, 0.0F, 1e-5F);
  EXPECT_NEAR(ahead.y / ahead.w, 0.0F, 1e-5F);
  const glm::vec4 above = project(pose, forward_of(pose) * 10.0F + glm::vec3(0, 1, 0));
  EXPECT_LT(above.y / above.w, 0.0F);  // up on the screen is −y in Vulkan
  const glm::vec4 right = project({}, {1.0F, 0.0F, -10.0F});
  EXPECT_GT(right.x / right.w, 0.0F);
}

TEST(Camera, DepthIsOneAtTheNearPlaneAndFallsTowardsZero) {
  const Projection projection;
  const glm::vec4 near_point = project({}, {0, 0, -projection.near_m});
  EXPECT_NEAR(near_point.z / near_point.w, 1.0F, 1e-6F);
  const glm::vec4 far_point = project({}, {0, 0, -1e6F});
  EXPECT_GT(far_point.z / far_point.w, 0.0F);
  EXPECT_LT(far_point.z / far_point.w, 1e-6F);
}

TEST(Camera, PosesThatAreNotFiniteAreInvalid) {
  CameraPose pose;
  EXPECT_TRUE(is_valid(pose));
  pose.position.local.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_valid(pose));
  pose.position.local.x = 1e30;
  EXPECT_FALSE(is_valid(pose));
  pose = {};
  pose.yaw = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_valid(pose));
}

}  // namespace
}  // namespace psygen::core
