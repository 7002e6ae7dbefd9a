#include "engine/render/frame/frame_data.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace psygen::render {
namespace {

constexpr core::Extent kFrameSize{400, 200};

TEST(FrameData, RaysOfTheSkyAgreeWithTheProjectionOfMeshes) {
  FrameInput input;
  input.pose.yaw = 0.7;
  input.pose.pitch = -0.3;
  input.projection.aspect = 2.0F;
  const shaders::FrameData frame = frame_data(input, kFrameSize);
  for (const glm::vec2 ndc : {glm::vec2(0, 0), glm::vec2(0.5F, -0.25F), glm::vec2(-1, 1)}) {
    const glm::vec3 ray = glm::vec3(frame.ray_forward) + ndc.x * glm::vec3(frame.ray_right) +
                          ndc.y * glm::vec3(frame.ray_down);
    const glm::vec4 clip = frame.clip_from_camera * glm::vec4(ray * 25.0F, 1.0F);
    EXPECT_NEAR(clip.x / clip.w, ndc.x, 1e-5F);
    EXPECT_NEAR(clip.y / clip.w, ndc.y, 1e-5F);
  }
}

TEST(FrameData, TheGroundPatternDoesNotMoveWithTheCamera) {
  FrameInput here, there;
  here.block_size_m = there.block_size_m = 60.0;
  here.pose.position.block = {-3, 1'000'000'007};
  here.pose.position.local = {59.5, 0, 1.25};
  there.pose.position.block = {-2, 1'000'000'007};
  there.pose.position.local = {-0.5, 0, 1.25};
  const glm::vec4 a = frame_data(here, kFrameSize).ground_anchor;
  const glm::vec4 b = frame_data(there, kFrameSize).ground_anchor;
  EXPECT_NEAR(a.x, b.x, 1e-3F);
  EXPECT_NEAR(a.y, b.y, 1e-3F);
  EXPECT_GE(a.x, 0.0F);
  EXPECT_LT(a.x, 2048.0F);
}

TEST(FrameData, HazeThinsWithTheHeightOfTheCamera) {
  FrameInput input;
  const float low = frame_data(input, kFrameSize).haze_extinction.y;
  input.pose.position.local.y = 500;
  const float high = frame_data(input, kFrameSize).haze_extinction.y;
  EXPECT_NEAR(high / low, std::exp(-500.0F * input.light.haze_height_falloff), 1e-4F);
}

TEST(FrameData, SurvivesASunWithoutDirectionAndPalettesWithoutBlends) {
  FrameInput input;
  input.light.sun_direction = {0, 0, 0};
  input.palette.dry_blend_m = 0;
  input.palette.rock_slope_start = 0.16F;
  input.palette.rock_slope_full = 0;
  const shaders::FrameData frame = frame_data(input, kFrameSize);
  EXPECT_FLOAT_EQ(glm::length(glm::vec3(frame.sun_direction)), 1.0F);
  EXPECT_GT(frame.dry.w, 0.0F);
  EXPECT_GT(frame.snow.w, frame.rock.w);
}

}  // namespace
}  // namespace psygen::render
