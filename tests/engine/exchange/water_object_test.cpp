#include "engine/exchange/water_object.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/world/river_world.hpp"

namespace psygen::exchange {
namespace {

using world::testing::kBrookLand;
using world::testing::parsed;
using world::testing::river_world;

TEST(WaterObject, CoversEveryWetVertexAtTheHeightOfTheWater) {
  const world::World& world = river_world();
  int wet = 0, blocks = 0;
  for (std::int32_t x = 24; x < 34; ++x) {
    const core::BlockCoord block{x, 26};
    const auto water = water_object(world, block);
    if (!water) continue;
    ++blocks;
    const Part& part = water->parts.front();
    ASSERT_EQ(part.material, kWater);
    ASSERT_EQ(part.indices.size(), part.positions.size() / 4 * 6);
    const glm::vec3* const positions = part.positions.data();
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const glm::vec3 a = positions[part.indices[i]], b = positions[part.indices[i + 1]],
                      c = positions[part.indices[i + 2]];
      ASSERT_GT((b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z), 0) << "upwards";
    }
    for (std::int32_t k = 0; k < 65; ++k) {
      const core::WorldPosition at{block, {2.0 * (k % 32), 0, 1.0 * k}};
      const auto here = world::water_at(world, at);
      if (here.is_dry() || k == 64) continue;
      ++wet;
      const auto same = std::ranges::find_if(part.positions, [&](const glm::vec3& p) {
        return part.positions.size() == 4 ||
               (p.x == static_cast<float>(at.local.x) && p.z == static_cast<float>(at.local.z));
      });
      ASSERT_NE(same, part.positions.end());
      EXPECT_NEAR(static_cast<double>(same->y), here.surface_m, 1e-4);
    }
  }
  EXPECT_GE(blocks, 5);
  EXPECT_GT(wet, 50);
}

TEST(WaterObject, OpenSeaIsOneCellAndDryLandHasNone) {
  const auto sea = water_object(river_world(), {24, 24});
  ASSERT_TRUE(sea);
  EXPECT_EQ(sea->parts[0].positions.size(), 4U);
  EXPECT_EQ(sea->parts[0].positions[3], glm::vec3(64, 26.25F, 64));
  EXPECT_FALSE(water_object(river_world(), {40, 26}));
  EXPECT_FALSE(water_object(parsed(world::testing::kSmallWorld), {2, 2}));
}

TEST(WaterObject, ACoarseNodeHasTheSameSurface) {
  const auto node = water_object(river_world(), {6, 6}, 2);
  ASSERT_TRUE(node);
  for (const glm::vec3& p : node->parts[0].positions) {
    EXPECT_GE(p.x, 0);
    EXPECT_LE(p.x, 256);
    EXPECT_GE(p.y, 26.25F);
  }
}

}  // namespace
}  // namespace psygen::exchange
