#include "engine/exchange/ground_colour.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/world/ground_blends.hpp"

namespace psygen::exchange {
namespace {

const glm::vec3 kFlat{0, 1, 0};
const glm::vec3 kSteep = glm::normalize(glm::vec3(1, 0.5F, 0));

float distance(const glm::vec3& a, const glm::vec3& b) {
  return glm::length(a - b) / glm::length(b);
}

TEST(GroundColour, FollowsHeightAndSlope) {
  world::Palette palette;
  palette.snow_start_m = 200;
  palette.sand_end_m = 0;
  const glm::vec2 at{100, 300};
  EXPECT_LT(distance(ground_albedo(palette, 400, kFlat, at, 7), palette.snow), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, -50, kFlat, at, 7), palette.sand), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, 150, kFlat, at, 7), palette.dry), 0.15F);
  EXPECT_LT(distance(ground_albedo(palette, 400, kSteep, at, 7), palette.rock), 0.15F);
}

TEST(GroundColour, IsContinuousAcrossBlocksAndWhereThePatternRepeats) {
  const world::Palette palette;
  const double size_m = 63;
  for (const core::BlockCoord block :
       {core::BlockCoord{0, 0}, core::BlockCoord{-1, 500}, core::BlockCoord{32, 32},
        core::BlockCoord{INT32_MAX - 1, 3}}) {
    const glm::vec2 here = world::pattern_place(block, size_m, {63, 10});
    const glm::vec2 there = world::pattern_place({block.x + 1, block.z}, size_m, {0, 10});
    EXPECT_LT(distance(ground_albedo(palette, 20, kFlat, here, 9),
                       ground_albedo(palette, 20, kFlat, there, 9)),
              1e-3F);
  }
  EXPECT_LT(distance(ground_albedo(palette, 20, kFlat, {2047.999F, 5}, 9),
                     ground_albedo(palette, 20, kFlat, {0, 5}, 9)),
            1e-3F);
}

TEST(GroundColour, NeverLeavesTheRangeOfColours) {
  const world::Palette palette;
  for (int i = 0; i < 2000; ++i) {
    const auto t = static_cast<float>(i);
    const glm::vec3 n = glm::normalize(glm::vec3(0.01F * t - 10, 1, 0.5F));
    const glm::vec3 c =
        ground_albedo(palette, t - 500, n, {t, 2 * t}, static_cast<std::uint16_t>(i));
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(c[k], 0.0F);
      EXPECT_LE(c[k], 1.0F);
    }
  }
}

}  // namespace
}  // namespace psygen::exchange
