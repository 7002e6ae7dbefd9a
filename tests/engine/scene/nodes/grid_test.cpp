#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "engine/scene/nodes/streaming.hpp"

namespace psygen::scene {
namespace {

TEST(NodeGrid, TheWindowIsCentredOnTheCamera) {
  NodeGrid grid(0, 2);
  grid.set_centre({10, -3});
  EXPECT_EQ(grid.side(), 5u);
  EXPECT_EQ(grid.node_at(0, 0).coord, (core::BlockCoord{8, -5}));
  EXPECT_EQ(grid.node_at(4, 4).coord, (core::BlockCoord{12, -1}));
  EXPECT_TRUE(grid.contains({8, -5}));
  EXPECT_FALSE(grid.contains({7, -3}));
  EXPECT_FALSE(grid.contains({10, 0}));
}

TEST(NodeGrid, ASmallerWindowKeepsTheEntitiesThatLieInIt) {
  NodeGrid grid(0, 3);
  grid.set_centre({5, 5});
  grid.entity_of({6, 4}) = {42, 1};
  grid.set_radius(1);
  EXPECT_EQ(grid.side(), 3u);
  EXPECT_EQ(grid.max_radius(), 3u);
  EXPECT_EQ(grid.node_at(0, 0).coord, (core::BlockCoord{4, 4}));
  EXPECT_EQ(grid.window_index({6, 4}), 2u);
  EXPECT_FALSE(grid.contains({7, 5}));
  EXPECT_EQ(grid.entity_of({6, 4}), (ecs::Entity{42, 1}));
}

TEST(NodeGrid, ACoarserWindowIsCentredOnTheNodeOfTheBlock) {
  NodeGrid grid(3, 1);
  grid.set_centre({17, -1});
  EXPECT_EQ(grid.centre().coord, (core::BlockCoord{2, -1}));
  EXPECT_EQ(grid.node_at(0, 2), (visibility::NodeCoord{{1, 0}, 3}));
  EXPECT_TRUE(grid.contains({3, -2}));
  EXPECT_FALSE(grid.contains({4, -1}));
}

TEST(NodeGrid, EveryNodeHasItsOwnCellAlsoAcrossTheWrapOfIndices) {
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{5}}) {
    for (const std::int32_t x : {0, -7, INT32_MAX, INT32_MIN}) {
      NodeGrid grid(level, 3);
      grid.set_centre({x, INT32_MAX});
      std::set<const ecs::Entity*> places;
      for (std::uint32_t row = 0; row < grid.side(); ++row) {
        for (std::uint32_t column = 0; column < grid.side(); ++column) {
          const core::BlockCoord coord = grid.node_at(column, row).coord;
          EXPECT_TRUE(grid.contains(coord));
          EXPECT_EQ(grid.window_index(coord), row * grid.side() + column);
          places.insert(&grid.entity_of(coord));
        }
      }
      EXPECT_EQ(places.size(), 49u);
    }
  }
}

}  // namespace
}  // namespace psygen::scene
