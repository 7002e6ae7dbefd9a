#include "engine/render/draw_choice.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/camera.hpp"
#include "engine/visibility/frustum.hpp"
#include "engine/visibility/level_choice.hpp"

namespace psygen::render {
namespace {

constexpr float kHeight = 720.0F;

struct Random {
  std::mt19937 engine{7};
  float in(float least, float greatest) {
    return std::uniform_real_distribution<float>(least, greatest)(engine);
  }
  core::Bounds box() {
    const glm::vec3 center(in(-500, 500), in(-60, 60), in(-500, 500));
    const glm::vec3 extent(in(0.1F, 30), in(0.1F, 30), in(0.1F, 30));
    return {center - extent, center + extent};
  }
};

FrameInput looking(Random& random) {
  FrameInput input;
  input.pose.yaw = random.in(-3.1F, 3.1F);
  input.pose.pitch = random.in(-1.2F, 1.2F);
  input.choose = true;
  return input;
}

glm::mat4 clip_of(const FrameInput& input) {
  return core::projection_matrix(input.projection) * core::view_rotation(input.pose);
}

TEST(DrawChoice, sees_what_the_frustum_of_the_visibility_system_sees) {
  Random random;
  int seen = 0;
  for (int camera = 0; camera < 20; ++camera) {
    const FrameInput input = looking(random);
    const ViewTest test = view_test(clip_of(input), input, kHeight);
    const visibility::Frustum frustum = visibility::make_frustum(clip_of(input));
    for (int i = 0; i < 500; ++i) {
      const core::Bounds box = random.box();
      EXPECT_EQ(in_view(test, box), visibility::intersects(frustum, box));
      seen += in_view(test, box) ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(seen, 9500);
}

TEST(DrawChoice, chooses_the_level_that_the_visibility_system_chooses_without_hysteresis) {
  Random random;
  std::array<int, 4> chosen{};
  for (int i = 0; i < 5000; ++i) {
    FrameInput input = looking(random);
    input.max_error_pixels = random.in(0.5F, 8.0F);
    const ViewTest test = view_test(clip_of(input), input, kHeight);
    const core::Bounds box = random.box();
    std::array<DrawLevel, 3> coarser{};
    std::array<float, 4> errors{};
    for (std::size_t level = 0; level < 3; ++level) {
      coarser[level].error_m = errors[level] + random.in(0.01F, 1.5F);
      errors[level + 1] = coarser[level].error_m;
    }
    const glm::vec3 nearest = glm::max(glm::max(box.min, -box.max), glm::vec3(0.0F));
    const int expected = visibility::choose_level(errors, glm::length(nearest),
                                                  input.projection.pixels_per_radian(kHeight),
                                                  input.max_error_pixels, -1);
    EXPECT_EQ(level_of(test, box, coarser), static_cast<std::size_t>(expected));
    ++chosen[level_of(test, box, coarser)];
  }
  for (const int count : chosen)
    EXPECT_GT(count, 100);
}

TEST(DrawChoice, takes_the_finest_level_around_the_camera_and_without_an_allowed_error) {
  FrameInput input;
  input.choose = true;
  std::array<DrawLevel, 1> coarser{};
  coarser[0].error_m = 0.01F;
  const core::Bounds around{{-1, -1, -1}, {1, 1, 1}}, far{{-1, -1, -4001}, {1, 1, -4000}};
  const ViewTest test = view_test(clip_of(input), input, kHeight);
  EXPECT_EQ(level_of(test, around, coarser), 0u);
  EXPECT_EQ(level_of(test, far, coarser), 1u);
  input.max_error_pixels = 0;
  EXPECT_EQ(level_of(view_test(clip_of(input), input, kHeight), far, coarser), 0u);
}

TEST(DrawChoice, puts_skirts_and_wind_into_the_boxes) {
  TerrainDraw terrain;
  terrain.origin = {10, -5, 20};
  terrain.cell_m = 2;
  terrain.height_min_m = 3;
  terrain.height_range_m = 7;
  terrain.skirt_m = 4;
  EXPECT_EQ(bounds_of(terrain), (core::Bounds{{10, -6, 20}, {264, 5, 274}}));
  terrain.side_m = 64;
  EXPECT_EQ(bounds_of(terrain), (core::Bounds{{10, -6, 20}, {74, 5, 84}}));
  MeshDraw mesh;
  mesh.origin = {1, 2, 3};
  mesh.box_center = {0, 4, 0};
  mesh.box_half_extent = {1, 4, 1};
  const core::Bounds box = bounds_of(mesh);
  EXPECT_FLOAT_EQ(box.min.y, 2.0F);
  EXPECT_FLOAT_EQ(box.max.y, 10.0F);
  EXPECT_FLOAT_EQ(box.max.x, 1.0F + 1.12F);
  EXPECT_FLOAT_EQ(box.min.z, 3.0F - 1.09F);
}

}  // namespace
}  // namespace psygen::render
