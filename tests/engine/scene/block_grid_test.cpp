#include "engine/scene/block_grid.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

namespace psygen::scene {
namespace {

TEST(BlockGrid, TheWindowIsCentredOnTheCamera) {
  BlockGrid grid(2);
  grid.set_centre({10, -3});
  EXPECT_EQ(grid.side(), 5u);
  EXPECT_EQ(grid.coord_at(0, 0), (core::BlockCoord{8, -5}));
  EXPECT_EQ(grid.coord_at(4, 4), (core::BlockCoord{12, -1}));
  EXPECT_TRUE(grid.contains({8, -5}));
  EXPECT_FALSE(grid.contains({7, -3}));
  EXPECT_FALSE(grid.contains({10, 0}));
}

TEST(BlockGrid, EveryBlockOfTheWindowHasAPlaceOfItsOwnAlsoAcrossTheWrapOfIndices) {
  for (const std::int32_t x : {0, -7, INT32_MAX, INT32_MIN}) {
    BlockGrid grid(3);
    grid.set_centre({x, INT32_MAX});
    std::set<const ecs::Entity*> places;
    for (std::uint32_t row = 0; row < grid.side(); ++row) {
      for (std::uint32_t column = 0; column < grid.side(); ++column) {
        const core::BlockCoord coord = grid.coord_at(column, row);
        EXPECT_TRUE(grid.contains(coord));
        EXPECT_EQ(grid.window_index(coord), row * grid.side() + column);
        places.insert(&grid.entity_of(coord));
      }
    }
    EXPECT_EQ(places.size(), 49u);
  }
}

}  // namespace
}  // namespace psygen::scene
