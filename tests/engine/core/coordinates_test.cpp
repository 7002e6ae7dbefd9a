#include "engine/core/coordinates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace psygen::core {
namespace {

TEST(Coordinates, NormalisingMovesWholeBlocksIntoTheIndex) {
  const WorldPosition p = normalised({{2, -1}, {130.5, 7.0, -0.25}}, 63.0);
  EXPECT_EQ(p.block, (BlockCoord{4, -2}));
  EXPECT_DOUBLE_EQ(p.local.x, 4.5);
  EXPECT_DOUBLE_EQ(p.local.y, 7.0);
  EXPECT_DOUBLE_EQ(p.local.z, 62.75);
}

TEST(Coordinates, OffsetsAreEquallyExactFarFromTheOrigin) {
  const WorldPosition near_origin{{0, 0}, {1.25, 2.0, 3.5}};
  const WorldPosition far_away{{1 << 30, -(1 << 30)}, {1.25, 2.0, 3.5}};
  const glm::dvec3 a = offset_m({3, 4}, near_origin, 63.0);
  const glm::dvec3 b = offset_m({(1 << 30) + 3, -(1 << 30) + 4}, far_away, 63.0);
  EXPECT_EQ(a, b);
  EXPECT_DOUBLE_EQ(a.x, 3 * 63.0 - 1.25);
}

TEST(Coordinates, TheWorldWrapsAtItsEdge) {
  const WorldPosition edge{{INT32_MAX, 0}, {62.0, 0, 0}};
  EXPECT_DOUBLE_EQ(offset_m({INT32_MIN, 0}, edge, 63.0).x, 1.0);
  EXPECT_EQ(normalised({{INT32_MAX, 0}, {64.0, 0, 0}}, 63.0).block.x, INT32_MIN);
}

TEST(Coordinates, BlocksMoveAcrossTheSeamOfTheIndices) {
  EXPECT_EQ(moved({5, -5}, -7, 7), (BlockCoord{-2, 2}));
  EXPECT_EQ(moved({INT32_MAX, INT32_MIN}, 1, -1), (BlockCoord{INT32_MIN, INT32_MAX}));
  EXPECT_EQ(moved({1, 2}, std::int64_t{1} << 32, -(std::int64_t{1} << 32)), (BlockCoord{1, 2}));
}

TEST(Coordinates, TheUnitedBoxIsTheSmallestAroundBoth) {
  const Bounds a{{0, 1, 2}, {3, 4, 5}}, b{{-1, 2, 1}, {2, 6, 4}};
  EXPECT_EQ(united(a, b), (Bounds{{-1, 1, 1}, {3, 6, 5}}));
  EXPECT_EQ(united(a, a), a);
}

TEST(Coordinates, OneInfiniteComponentMakesAVectorInfinite) {
  EXPECT_TRUE(is_finite(glm::dvec3(1e308)));
  EXPECT_TRUE(is_finite(glm::vec3(-1e38F)));
  for (int i = 0; i < 3; ++i) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      glm::dvec3 v(0.0);
      v[i] = bad;
      EXPECT_FALSE(is_finite(v));
      EXPECT_FALSE(is_finite(glm::vec3(v)));
    }
  }
}

}  // namespace
}  // namespace psygen::core
