#include "engine/gltf/animation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace psygen::gltf {
namespace {

Channel slide(Interpolation interpolation) {
  Channel channel;
  channel.interpolation = interpolation;
  channel.times_s = {1, 2, 4};
  channel.values = {{0, 0, 0, 0}, {1, 0, 0, 0}, {3, 0, 0, 0}};
  return channel;
}

TEST(Channel, StepsStayLinesAreStraightAndEndsHold) {
  const Channel steps = slide(Interpolation::kStep), line = slide(Interpolation::kLinear);
  EXPECT_EQ(value_at(steps, 1.9F).x, 0.0F);
  EXPECT_EQ(value_at(steps, 2.0F).x, 1.0F);
  EXPECT_EQ(value_at(line, 3.0F).x, 2.0F);
  for (const Channel& channel : {steps, line}) {
    EXPECT_EQ(value_at(channel, 0).x, 0.0F);
    EXPECT_EQ(value_at(channel, 9).x, 3.0F);
  }
}

TEST(Channel, SplinesPassTheirValuesWithTheirTangents) {
  Channel channel = slide(Interpolation::kCubic);
  channel.times_s = {0, 2};
  channel.values = {{9, 0, 0, 0},  {1, 0, 0, 0}, {3, 0, 0, 0},  // in, value, out
                    {-1, 0, 0, 0}, {5, 0, 0, 0}, {9, 0, 0, 0}};
  EXPECT_EQ(value_at(channel, 0).x, 1.0F);
  EXPECT_EQ(value_at(channel, 2).x, 5.0F);
  EXPECT_FLOAT_EQ(value_at(channel, 1).x, (1 + 5) / 2.0F + 2 * (3 - -1) / 8.0F);
  const float h = 1e-3F;
  EXPECT_NEAR((value_at(channel, h).x - 1) / h, 3, 0.02);
  EXPECT_NEAR((5 - value_at(channel, 2 - h).x) / h, -1, 0.02);
}

TEST(Channel, RotationsTurnEvenlyTheShortWayAndHaveUnitLength) {
  Channel channel;
  channel.property = Property::kRotation;
  channel.times_s = {0, 1};
  const float half = std::sqrt(0.5F);
  channel.values = {{0, 0, 0, 1}, {0, 0, -half, -half}};  // 90° about z, with the other sign
  for (const float t : {0.0F, 0.25F, 0.5F, 1.0F}) {
    Pose pose;
    apply(channel, t, pose);
    EXPECT_NEAR(glm::length(pose.rotation), 1, 1e-6);
    const glm::vec3 x = pose.rotation * glm::vec3(1, 0, 0);
    EXPECT_NEAR(std::atan2(x.y, x.x), t * 1.5708, 1e-4);
    EXPECT_EQ(pose.scale, glm::vec3(1));
  }
}

TEST(Animation, StartsAgainOrStaysAtItsEnds) {
  Animation animation;
  animation.duration_s = 2;
  EXPECT_FLOAT_EQ(place_in(animation, 5, true), 1);
  EXPECT_FLOAT_EQ(place_in(animation, -0.5, true), 1.5F);
  EXPECT_FLOAT_EQ(place_in(animation, 5, false), 2);
  EXPECT_FLOAT_EQ(place_in(animation, -5, false), 0);
  EXPECT_FLOAT_EQ(place_in(animation, NAN, true), 0);
  animation.duration_s = 0;
  EXPECT_FLOAT_EQ(place_in(animation, 5, true), 0);
}

}  // namespace
}  // namespace psygen::gltf
