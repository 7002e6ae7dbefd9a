#include "engine/core/coordinates.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace psygen::core
