#include "editor/tools/new_mask.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/world/world.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using ::testing::HasSubstr;

constexpr glm::dvec2 kPlace{1000, -200};

// A world with blocks of 63 m.
world::World world_of(std::int64_t blocks) {
  const std::string text =
      testing::replaced(testing::kWorld, "[8, 4]", fmt::format("[{}, {}]", blocks, blocks / 2));
  return parse_world_text(text, "test", {})->get()->world;
}

TEST(NewMask, DefaultsFitTheWorld) {
  const NewMask small = default_new_mask(world_of(8));
  EXPECT_TRUE(small.whole_world);
  EXPECT_EQ(small.pixel_m, 2);
  const NewMask middle = default_new_mask(world_of(64));
  EXPECT_TRUE(middle.whole_world);
  EXPECT_EQ(middle.pixel_m, 4) << "at most 1,024 pixels a side";
  EXPECT_EQ(default_new_mask(world_of(66)), NewMask()) << "1,024 m around the view";
  EXPECT_EQ(default_new_mask(world_of(0)), NewMask()) << "without an end";
}

TEST(NewMask, OfTheWholeWorldHasItsShape) {
  const world::World world = world_of(8);
  const auto plan = plan_of({true, 50, 3}, world, kPlace);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->area_m, (std::array<double, 4>{0, 0, 504, 252}));
  EXPECT_EQ(plan->width, 168U);
  EXPECT_EQ(plan->height, 84U);
  // An endless world has no whole.
  EXPECT_EQ(area_of({true, 64, 2}, world_of(0), {0, 0}), (std::array<double, 4>{-32, -32, 32, 32}));
}

TEST(NewMask, ASquareContainsItsPointAndStaysWhileThePointMovesALittle) {
  for (const double side_m : {16.0, 100.0, 1024.0, 65'536.0}) {
    const NewMask mask{false, side_m, 64};
    const auto area = area_of(mask, world_of(0), kPlace);
    EXPECT_EQ(area[2] - area[0], side_m);
    EXPECT_EQ(area[3] - area[1], side_m);
    EXPECT_NEAR((area[0] + area[2]) / 2, kPlace.x, side_m / 16);
    EXPECT_NEAR((area[1] + area[3]) / 2, kPlace.y, side_m / 16);
    int moved = 0;
    for (int i = 1; i <= 32; ++i)
      moved += area_of(mask, world_of(0), kPlace + glm::dvec2(side_m / 16 * i / 32, 0)) != area;
    EXPECT_LE(moved, 32);
    EXPECT_GE(moved, 1) << "it follows";
    EXPECT_EQ(area_of(mask, world_of(0), kPlace + glm::dvec2(0, 0.01)), area);
  }
}

TEST(NewMask, BeyondItsLimitsIsRejectedWithAMessage) {
  const auto refused = [](NewMask mask, std::int64_t blocks = 0) {
    const auto plan = plan_of(mask, world_of(blocks), kPlace);
    return plan ? std::string() : plan.error().message;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused({false, 15, 1}), HasSubstr("side is 15 m (allowed: 16 to 65536 m)"));
  EXPECT_THAT(refused({false, 1e9, 1}), HasSubstr("side is 1e+09 m"));
  EXPECT_THAT(refused({false, none, 1}), HasSubstr("side is nan m"));
  EXPECT_THAT(refused({false, 64, 0}), HasSubstr("pixel is 0 m"));
  EXPECT_THAT(refused({false, 64, none}), HasSubstr("pixel is nan m"));
  EXPECT_THAT(refused({false, 4097, 1}), HasSubstr("4097 pixels a side (allowed: 4096)"));
  EXPECT_THAT(refused({true, 64, 1}, 1 << 20), HasSubstr("Make the area smaller"));
  EXPECT_EQ(refused({false, 4096, 1}), "");
  const auto tiny = plan_of({false, 16, 256}, world_of(0), kPlace);
  ASSERT_TRUE(tiny);
  EXPECT_EQ(tiny->width, NewMask::kMinPixels);
}

TEST(NewMask, TheMiddleOfAViewIsTheGroundInFrontOfTheCamera) {
  const world::World world = world_of(0);
  core::CameraPose pose;
  pose.position = core::normalised({{0, 0}, {kPlace.x, 0, kPlace.y}}, world.block_size_m());
  pose.position.local.y = world::surface_height_m(world, pose.position) + 30;
  pose.pitch = -std::atan(0.5);
  pose.yaw = std::acos(0.0);  // to +x
  EXPECT_LT(glm::length(middle_of_view(pose, world, 400) - (kPlace + glm::dvec2(60, 0))), 1e-6);
  EXPECT_LT(glm::length(middle_of_view(pose, world, 40) - (kPlace + glm::dvec2(40, 0))), 1e-6);
  pose.pitch = 0.3;  // the sky
  EXPECT_LT(glm::length(middle_of_view(pose, world, 400) - (kPlace + glm::dvec2(400, 0))), 1e-6);
  pose.position.local.y -= 100;  // under the ground
  pose.pitch = -0.3;
  EXPECT_LT(glm::length(middle_of_view(pose, world, 400) - kPlace), 1e-6);
}

}  // namespace
}  // namespace psygen::editor
