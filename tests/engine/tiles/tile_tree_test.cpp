#include "engine/tiles/tile_tree.hpp"

#include <gtest/gtest.h>

namespace psygen::tiles {
namespace {

TEST(TileTree, LevelsAreReadFromTheFinestToTheCoarsest) {
  EXPECT_EQ(parse_levels("0-5")->coarsest, 5);
  EXPECT_EQ(parse_levels("3")->finest, 3);
  for (const char* text : {"", "-", "5-0", "0-21", "-1-2", "1-", "a", "1-2-3", "1 -2"})
    EXPECT_FALSE(parse_levels(text)) << text;
}

// Every block of the region is in one tile of each level, and in that tile's node.
TEST(TileTree, EveryBlockHasATileOfEachLevelWithItsNode) {
  const amplify::Region region{-5, 3, 9, 10};
  const auto tree = TileTree::over(region, {1, 3});
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->corner(), (core::BlockCoord{-8, 0}));
  EXPECT_EQ(tree->side_blocks(), 32u);
  EXPECT_EQ(tree->level_count(), 5);  // nodes of 32, 16, 8, 4 and 2 blocks
  for (int level = 0; level < tree->level_count(); ++level) {
    std::uint64_t existing = 0;
    const std::uint32_t side = 1U << level;
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        existing += tree->exists({level, x, y}) ? 1 : 0;
    std::uint64_t held = 0;
    for (std::uint64_t i = 0; i < region.block_count(); ++i) {
      const core::BlockCoord block = region.block(i);
      const int k = tree->node_level({level, 0, 0});
      const Tile tile{level, static_cast<std::uint32_t>((block.x + 8) >> k),
                      side - 1 - static_cast<std::uint32_t>(block.z >> k)};
      EXPECT_TRUE(tree->exists(tile));
      EXPECT_EQ(tree->has_content(tile), k <= 3);
      if (k <= 3) {
        EXPECT_EQ(tree->node(tile), (core::BlockCoord{block.x >> k, block.z >> k}));
      }
      ++held;
    }
    EXPECT_EQ(held, region.block_count());
    EXPECT_GE(existing, 1u);
  }
  EXPECT_FALSE(tree->exists({4, 0, 15})) << "north-west of the region";
  EXPECT_FALSE(tree->exists({5, 0, 0})) << "finer than the finest level";
}

TEST(TileTree, RowsCountFromTheSouth) {
  const auto tree = TileTree::over({0, 0, 4, 4}, {0, 2});
  EXPECT_EQ(tree->south({2, 0, 3}), 0u);
  EXPECT_EQ(tree->south({2, 0, 0}), 3u);
  EXPECT_EQ(tree->east({1, 1, 0}), 2u);
}

TEST(TileTree, HasLimits) {
  EXPECT_FALSE(TileTree::over({0, 0, 1 << 21, 1}, {0, 3}));
  const std::int64_t end = std::int64_t{INT32_MAX} + 1;
  EXPECT_TRUE(TileTree::over({end - 4, end - 4, end, end}, {0, 2}));
  EXPECT_FALSE(TileTree::over({end - 5, end - 4, end, end}, {0, 1}));
}

}  // namespace
}  // namespace psygen::tiles
