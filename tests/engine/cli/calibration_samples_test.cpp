#include "engine/cli/calibration_samples.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::cli {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

world::World world_of(std::int64_t blocks_x, std::int64_t blocks_z) {
  world::World world = parsed(kSmallWorld);
  world.blocks_x = blocks_x;
  world.blocks_z = blocks_z;
  return world;
}

TEST(CalibrationSamples, BlocksExistAndTheHalvesAreDisjoint) {
  for (const auto& [x, z] :
       {std::pair<int, int>{512, 512}, {8, 4}, {1, 9}, {9, 1}, {2, 1}, {0, 3}, {0, 0}}) {
    const world::World world = world_of(x, z);
    const auto fitted = sample_blocks(world, 0, 64), held_out = sample_blocks(world, 1, 64);
    EXPECT_FALSE(fitted.empty());
    EXPECT_FALSE(held_out.empty());
    std::set<core::BlockCoord> all(fitted.begin(), fitted.end());
    all.insert(held_out.begin(), held_out.end());
    EXPECT_EQ(all.size(), fitted.size() + held_out.size()) << x << " x " << z;
    for (const core::BlockCoord block : all)
      EXPECT_TRUE(world.contains(block)) << block.x << "," << block.z;
  }
  EXPECT_EQ(sample_blocks(world_of(512, 512), 1, 64).size(), 64u);
  EXPECT_EQ(sample_blocks(world_of(1, 1), 0, 64), sample_blocks(world_of(1, 1), 1, 64));
}

TEST(CalibrationSamples, RareTypesAreSearchedInMoreBlocks) {
  const world::World world = world_of(512, 512);  // three trees and five rocks on each block
  std::vector<std::size_t> found(registry().size(), 0);
  for (const synthesis::CostSample& sample : world_samples(world, registry(), 1, 10))
    ++found[sample.model];
  EXPECT_EQ(found[world.terrain_model], 10u);
  std::set<std::int64_t> node_levels;
  for (const synthesis::CostSample& sample : world_samples(world, registry(), 0, 10)) {
    if (sample.model == world.terrain_model)
      node_levels.insert(sample.parameters.integer(models::kTerrainNodeLevel));
  }
  EXPECT_EQ(node_levels.size(), 10u);
  for (const world::Scatter& scatter : world.scatter)
    EXPECT_EQ(found[scatter.model], 10u);
  world::World sparse = world;
  sparse.scatter.resize(1);
  sparse.scatter[0].count = 1;
  sparse.scatter[0].max_slope_deg = 8;  // some blocks have no trees
  std::size_t trees = 0;
  for (const synthesis::CostSample& sample : world_samples(sparse, registry(), 0, 10))
    trees += sample.model == sparse.scatter[0].model ? 1 : 0;
  EXPECT_EQ(trees, 10u);
}

}  // namespace
}  // namespace psygen::cli
