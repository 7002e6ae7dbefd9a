#include "engine/world/node_walk.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/engine/world/files.hpp"

namespace psygen::world {
namespace {

TEST(NodeWalk, VisitsEveryBlockOfANodeOnce) {
  const World world = testing::parsed(testing::kSmallWorld);
  for (int level = 1; level <= 5; ++level) {
    const NodeWalk walk(world, {-3, 2}, level);
    std::set<core::BlockCoord> blocks;
    std::uint32_t tiles = 0;
    const std::int32_t side = 1 << level;
    for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
      const NodeBlock block = walk.block(i);
      blocks.insert(block.coord);
      EXPECT_GE(block.coord.x, -3 * side);
      EXPECT_LT(block.coord.x, -2 * side);
      EXPECT_GE(block.coord.z, 2 * side);
      EXPECT_LT(block.coord.z, 3 * side);
      EXPECT_EQ(block.in_node_m.x, (block.coord.x + 3 * side) * world.block_size_m());
      EXPECT_LT(block.in_tile_m.x, walk.tile_side_m());
      tiles += walk.starts_tile(i) ? 1 : 0;
      EXPECT_EQ(walk.starts_tile(i), block.in_tile_m == glm::dvec2(0));
    }
    EXPECT_EQ(blocks.size(), static_cast<std::size_t>(side * side));
    EXPECT_EQ(tiles, ground_tiles(level));
    EXPECT_LE(tiles, 16U);
  }
}

// The vertices of a tile's lattice are those of the blocks, at any distance from the origin.
TEST(NodeWalk, FindsTheGroundOfTheBlocksUnderItsTiles) {
  const World world = testing::parsed(testing::kSmallWorld);
  for (const int level : {2, 3, 4}) {
    const NodeWalk walk(world, {INT32_MAX >> level, INT32_MIN >> level}, level);
    std::optional<models::BlockGround> ground;
    for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
      if (walk.starts_tile(i)) walk.make_ground(i, ground);
      const NodeBlock block = walk.block(i);
      const glm::dvec2 at = glm::dvec2(16, 8) * world.cell_m();
      const models::GroundPoint tile = ground->at(block.in_tile_m + at);
      EXPECT_EQ(tile.height_m, models::ground_height_m(world.terrain, block.coord, at.x, at.y));
    }
  }
}

}  // namespace
}  // namespace psygen::world
