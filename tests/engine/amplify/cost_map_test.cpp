#include "engine/amplify/cost_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/amplify/forest_world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::amplify {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

TEST(CostMap, AccumulatesStretchByStretch) {
  const CostMap map = CostMap::from(7, {1, 10, 100});  // 3, 2 and 2 blocks
  EXPECT_DOUBLE_EQ(map.total_s(), 223);
  EXPECT_DOUBLE_EQ(map.seconds_before(0), 0);
  EXPECT_DOUBLE_EQ(map.seconds_before(3), 3);
  EXPECT_DOUBLE_EQ(map.seconds_before(4), 13);
  EXPECT_DOUBLE_EQ(map.seconds_before(7), 223);
  for (std::uint64_t block = 0; block <= 7; ++block)
    EXPECT_EQ(map.block_at(map.seconds_before(block)), block);
  EXPECT_EQ(map.block_at(12), 3u);
  EXPECT_EQ(map.block_at(1e9), 7u);
  EXPECT_DOUBLE_EQ(map.seconds_of(BlockRanges({2, 5})), 1 + 20.0);
}

TEST(CostMap, ShardsHaveEveryBlockOnceAndEqualCosts) {
  const CostMap map = CostMap::from(1000, {1, 1, 1, 50, 1});
  for (const std::uint64_t n : {1u, 2u, 3u, 7u, 64u, 2000u}) {
    std::uint64_t next = 0;
    for (std::uint64_t i = 1; i <= n; ++i) {
      const BlockRun share = shard_of(map, i, n);
      ASSERT_EQ(share.first, next);
      ASSERT_GE(share.end, share.first);
      next = share.end;
      const double cost = map.seconds_of(BlockRanges(share));
      EXPECT_NEAR(cost, map.total_s() / static_cast<double>(n), 50.001);  // a block more or less
    }
    EXPECT_EQ(next, 1000u);
  }
}

// The costs follow the models on the blocks of the world.
TEST(CostMap, OfAForestInTheCornerOfADesertLocatesTheWork) {
  const world::World world = world::testing::forest_in_a_desert();
  const Region region = *whole(world);
  const auto price_of = [&](core::BlockCoord at) {
    const Region block{at.x, at.z, at.x + 1, at.z + 1};
    return prices_of(world, registry(), block, {}, 0, 1).front();
  };
  const double desert = price_of({10, 10});
  const double forest = price_of({1, 1});
  EXPECT_GT(forest, 100 * desert);
  const CostMap map = CostMap::of(world, registry(), region, {});
  double exact = 0;
  for (std::uint64_t i = 0; i < region.block_count(); ++i)
    exact += price_of(region.block(i));
  EXPECT_NEAR(map.total_s() / exact, 1, 0.2);
  EXPECT_LE(shard_of(map, 1, 2).end, region.block_count() / 8);
}

TEST(CostMap, IsReproducibleAndIncludesTheCostOfFiles) {
  const world::World world = parsed(kSmallWorld);
  const Region region = *whole(world);
  const CostMap one = CostMap::of(world, registry(), region, {}),
                two = CostMap::of(world, registry(), region, {}),
                files = CostMap::of(world, registry(), region, CostRates::with_files(true));
  for (std::uint64_t block = 0; block <= region.block_count(); ++block)
    EXPECT_EQ(one.seconds_before(block), two.seconds_before(block));
  EXPECT_GT(files.total_s(), 10 * one.total_s());
  EXPECT_NEAR(one.plus(0.5).total_s(), one.total_s() + 0.5 * 32, 1e-9);
}

}  // namespace
}  // namespace psygen::amplify
