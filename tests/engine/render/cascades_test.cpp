// Where the sun's shadow maps end, shadows fade out over a long way, without an edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "engine/render/preset.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;

constexpr core::Extent kSize{320, 360};
constexpr double kHeight = 200, kPitch = -0.5;

// A long wall beside a strip of ground, in the shadow of the wall.
class Cascades : public testing::Test {
 protected:
  void SetUp() override {
    auto made = synthetic::open_renderer(Preset::kHigh, kSize);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
    const auto grid = renderer_->upload_shared_indices(synthetic::grid_indices(kGroundSide));
    const auto flat =
        synthetic::make_terrain(renderer_->geometry(), kGroundSide, [](int, int) { return 0.0F; });
    const auto box = synthetic::make_box(renderer_->geometry(), glm::vec3(0.3F));
    ASSERT_TRUE(grid && flat && box);
    terrain_.range = *flat;
    terrain_.shared_indices = *grid;
    terrain_.origin = {-512.0F, -kHeight, -1000.0F};
    terrain_.cell_m = 16.0F;
    wall_.range = *box;
    wall_.origin = {-10.0F, -kHeight, -500.0F};
    wall_.box_centre = {0, 12, 0};
    wall_.box_half_extent = {3, 12, 500};
  }
  void TearDown() override {
    if (!renderer_) return;
    renderer_->wait_idle();
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }
  std::vector<std::uint8_t> draw(bool wall) {
    FrameInput input = synthetic::look(kHeight, kPitch, kSize);
    input.terrain = {&terrain_, 1};
    if (wall) input.models = {&wall_, 1};
    input.light.sun_direction = {-1.0F, 1.0F, 0.0F};
    input.light.haze_density = 0.0F;
    input.light.cloud_cover = -1.0F;
    fov_ = input.projection.vertical_fov;
    EXPECT_TRUE(renderer_->render(input));
    auto picture = renderer_->capture();
    return picture ? std::move(picture->rgba)
                   : std::vector<std::uint8_t>(kSize.width * kSize.height * 4);
  }
  // Red, green and blue of the ground in the strip, so many metres ahead.
  double at(const std::vector<std::uint8_t>& picture, double ahead) const {
    const double deep = std::cos(kPitch) * ahead - std::sin(kPitch) * kHeight;
    const double down = std::cos(kPitch) * kHeight + std::sin(kPitch) * ahead;
    const double unit = kSize.height * 0.5 / std::tan(fov_ * 0.5) / deep;
    const auto x = static_cast<std::size_t>(kSize.width * 0.5 + 5 * unit);
    const auto y = static_cast<std::size_t>(
        std::clamp(kSize.height * 0.5 + down * unit, 0.0, kSize.height - 1.0));
    const std::uint8_t* const pixel = &picture[4 * (y * kSize.width + x)];
    return pixel[0] + pixel[1] + pixel[2];
  }

  std::unique_ptr<Renderer> renderer_;
  TerrainDraw terrain_;
  MeshDraw wall_;
  double fov_ = 1;
};

TEST_F(Cascades, EndWithoutAnEdge) {
  const auto lit = draw(false), shaded = draw(true);
  const double end = traits_of(Preset::kHigh).reach_m[1];
  double before = -1, largest = 0, steepest = 0, last = 0;
  for (double away = 230; away <= end; away += 10) {
    const double ahead = std::sqrt(away * away - kHeight * kHeight);
    const double dark = 1 - at(shaded, ahead) / at(lit, ahead);
    if (before >= 0) steepest = std::max(steepest, std::abs(dark - before));
    largest = std::max(largest, dark);
    before = last = dark;
  }
  EXPECT_GT(largest, 0.3) << "the strip lies in the shadow";
  EXPECT_LT(last, 0.03);
  EXPECT_LT(steepest, 0.14 * largest);
}

}  // namespace
}  // namespace psygen::render
