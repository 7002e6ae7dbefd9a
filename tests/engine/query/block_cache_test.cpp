#include "engine/query/block_cache.hpp"

#include "engine/world/edits/edits.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::query {
namespace {

using testing::kBounded;
using testing::Loaded;

TEST(BlockCache, EqualsTheWorld) {
  const Loaded loaded = Loaded::parsed(kBounded);
  BlockCache cache(loaded.world, loaded.registry, std::size_t{1} << 20);
  const core::BlockCoord block{3, 1};
  EXPECT_EQ(cache.ground(block).size(), 33);
  std::vector<world::Placement> placed;
  world::place_models(loaded.world, loaded.registry, block, placed);
  const auto models = cache.models(block);
  ASSERT_EQ(models.size(), placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(models[i].position, placed[i].position);
    EXPECT_EQ(models[i].parameters, placed[i].parameters);
  }
  EXPECT_EQ(cache.solids(block).solids.size(), 8U);  // every tree and every rock
}

TEST(BlockCache, StaysUnderItsBoundAndDropsTheLeastRecentlyUsedBlock) {
  const Loaded loaded = Loaded::parsed(kBounded);
  constexpr std::size_t kBound = 100'000;
  BlockCache cache(loaded.world, loaded.registry, kBound);
  for (int round = 0; round < 3; ++round) {
    for (std::int32_t x = 1; x < 50; ++x) {
      cache.ground({x, 0});
      cache.solids({x, 0});
      cache.ground({0, 0});
      ASSERT_LE(cache.bytes(), kBound);
      ASSERT_GE(cache.size(), 2U);
    }
  }
  const std::size_t size = cache.size(), bytes = cache.bytes();
  cache.ground({0, 0});
  cache.solids({49, 0});
  EXPECT_EQ(cache.size(), size);  // both were still cached
  EXPECT_EQ(cache.bytes(), bytes);
}

TEST(BlockCache, KeepsOneBlockWithAnyBound) {
  const Loaded loaded = Loaded::parsed(kBounded);
  BlockCache cache(loaded.world, loaded.registry, 1);
  cache.ground({0, 0});
  EXPECT_EQ(cache.solids({1, 0}).solids.size(), 8U);
  EXPECT_EQ(cache.size(), 1U);
}

TEST(BlockCache, FollowsEditsAndKeepsTheBlocksThatTheyDoNotReach) {
  Loaded loaded = Loaded::parsed(kBounded);
  BlockCache cache(loaded.world, loaded.registry, std::size_t{1} << 22);
  for (std::int32_t x = 0; x < 8; ++x)
    cache.solids({x, 1});
  const std::size_t models = cache.models({2, 1}).size();
  const std::uint16_t low = cache.ground({6, 1}).heights()[10 * 33 + 10];
  const std::size_t blocks = cache.size();

  world::Edits edits;
  const std::uint32_t index = cache.models({2, 1})[0].index;
  ASSERT_TRUE(edits.remove(loaded.world, {{2, 1}, index}));
  world::set_edits(loaded.world, edits.layer());
  EXPECT_EQ(cache.models({2, 1}).size(), models - 1);
  EXPECT_EQ(cache.size(), blocks) << "one is rebuilt";

  const double size = loaded.world.block_size_m();
  ASSERT_TRUE(edits.raise(loaded.world, {{6, 1}, {0.3 * size, 0, 0.3 * size}}, 0.3 * size, 3));
  world::set_edits(loaded.world, edits.layer());
  EXPECT_GT(cache.ground({6, 1}).heights()[10 * 33 + 10], low);
  EXPECT_LE(cache.size(), blocks);
  EXPECT_GE(cache.size(), blocks / 2);

  world::set_edits(loaded.world, nullptr);
  EXPECT_EQ(cache.models({2, 1}).size(), models);
  EXPECT_EQ(cache.ground({6, 1}).heights()[10 * 33 + 10], low);
}

}  // namespace
}  // namespace psygen::query
