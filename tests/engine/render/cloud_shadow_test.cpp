// Clouds shade the land where they hide the sun in the sky, in presets with shadows, and stand
// still over it when the camera moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;
using synthetic::kPictureSize;

const glm::vec3 kSun{0.0F, 0.6F, -0.8F};

class CloudShadows : public testing::Test {
 protected:
  void open(Preset preset) {
    auto made = synthetic::open_renderer(preset);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
    const auto grid = renderer_->upload_shared_indices(synthetic::grid_indices(kGroundSide));
    const auto flat =
        synthetic::make_terrain(renderer_->geometry(), kGroundSide, [](int, int) { return 0.5F; });
    ASSERT_TRUE(grid && flat);
    terrain_.range = *flat;
    terrain_.shared_indices = *grid;
    terrain_.origin = {-128.0F, -60.0F, -128.0F};
    terrain_.cell_m = 4.0F;
  }
  void TearDown() override {
    if (!renderer_) return;
    renderer_->wait_idle();
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }
  // Red, green and blue of a square of 16 pixels in the middle.
  double middle(double pitch, float cover, float seconds, double moved_m = 0) {
    FrameInput input = synthetic::look(60.0, pitch, kPictureSize);
    input.block_size_m = 64;
    input.pose.position.local.x += moved_m;
    input.terrain = {&terrain_, 1};
    input.light.sun_direction = kSun;
    input.light.haze_density = 0.0F;
    input.light.cloud_cover = cover;
    input.light.time_seconds = seconds;
    EXPECT_TRUE(renderer_->render(input));
    const auto picture = renderer_->capture();
    if (!picture) return 0;
    double sum = 0;
    for (std::uint32_t y = 0; y < 16; ++y) {
      for (std::uint32_t x = 0; x < 16; ++x) {
        const std::size_t at =
            (kPictureSize.height / 2 - 8 + y) * kPictureSize.width + kPictureSize.width / 2 - 8 + x;
        for (std::size_t c = 0; c < 3; ++c)
          sum += picture->rgba[4 * at + c];
      }
    }
    return sum / 768;
  }
  // Of the ground below the camera, the light that is left by clouds.
  double left_on_ground(float seconds, double moved_m = 0) {
    return middle(-1.5, 0.5F, seconds, moved_m) / middle(-1.5, -1.0F, seconds, moved_m);
  }
  // The difference of the sky around the sun from a clear sky.
  double hidden_sun(float seconds) {
    const double up = std::asin(kSun.y);
    return std::abs(middle(up, 0.5F, seconds) - middle(up, -1.0F, seconds));
  }

  std::unique_ptr<Renderer> renderer_;
  TerrainDraw terrain_;
};

TEST_F(CloudShadows, LieWhereCloudsHideTheSun) {
  open(Preset::kHigh);
  int shaded = 0, lit = 0;
  for (float seconds = 0; seconds < 400; seconds += 20) {
    const double left = left_on_ground(seconds), hidden = hidden_sun(seconds);
    SCOPED_TRACE(testing::Message() << seconds << " s: " << left << ", " << hidden);
    if (hidden > 25) {
      EXPECT_LT(left, 0.9);
      ++shaded;
    } else if (hidden < 1) {
      EXPECT_GT(left, 0.97);
      ++lit;
    }
  }
  EXPECT_GT(shaded, 0);
  EXPECT_GT(lit, 0);
}

// After so many metres clouds repeat (frame_data.cpp).
constexpr double kPeriodM = 1100.0 / 0.27;

TEST_F(CloudShadows, StandOverTheLandWhenTheCameraMoves) {
  open(Preset::kHigh);
  double changed = 0;
  for (float seconds = 180; seconds < 300; seconds += 20) {
    const double here = left_on_ground(seconds);
    EXPECT_NEAR(left_on_ground(seconds, kPeriodM), here, 0.1);
    changed = std::max(changed, std::abs(left_on_ground(seconds, 400) - here));
  }
  EXPECT_GT(changed, 0.2);
}

TEST_F(CloudShadows, AreNotInPresetsWithoutShadows) {
  open(Preset::kMedium);
  for (float seconds = 0; seconds < 400; seconds += 100)
    EXPECT_NEAR(left_on_ground(seconds), 1.0, 1e-6);
}

}  // namespace
}  // namespace psygen::render
