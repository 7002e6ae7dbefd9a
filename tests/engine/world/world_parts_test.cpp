#include "engine/world/world_parts.hpp"

#include <gtest/gtest.h>

#include "engine/world/placement.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::registry;

// The two scatters of the small world, and one after them.
World three_scatters() {
  return parse_world(std::string(testing::kSmallWorld) +
                         "\n[[scatter]]\nmodel = \"tree\"\ncount = 7\nmax_slope_deg = 40\n",
                     "w.toml", registry())
      .value();
}

TEST(WorldParts, IgnoreColoursAndSky) {
  World world = three_scatters();
  const WorldParts before = parts_of(world, registry());
  world.name = "another";
  world.sky.exposure = 2;
  world.palette.grass = glm::vec3(0.5F);
  EXPECT_EQ(parts_of(world, registry()), before);
}

TEST(WorldParts, OtherRangesOfAScatterChangeOnlyItsModels) {
  World world = three_scatters();
  const WorldParts before = parts_of(world, registry());
  world.scatter.back().ranges[1].high += 1;
  const WorldParts after = parts_of(world, registry());
  EXPECT_EQ(after.ground, before.ground);
  EXPECT_EQ(after.places, before.places);
  EXPECT_EQ(after.models.front(), before.models.front());
  EXPECT_NE(after.models.back(), before.models.back());
}

// Later instances get other indices, so all their values are drawn again.
TEST(WorldParts, AnotherCountChangesAllLaterScatters) {
  World world = three_scatters();
  const WorldParts before = parts_of(world, registry());
  ++world.scatter.front().count;
  const WorldParts after = parts_of(world, registry());
  EXPECT_NE(after.places.back(), before.places.back());
  EXPECT_NE(after.models.back(), before.models.back());
}

TEST(WorldParts, OtherGroundMovesAllPlacesAndNoModel) {
  World world = three_scatters();
  const WorldParts before = parts_of(world, registry());
  world.terrain.set_real(models::kTerrainReliefM, world.terrain.real(models::kTerrainReliefM) + 1);
  const WorldParts after = parts_of(world, registry());
  EXPECT_NE(after.ground, before.ground);
  for (std::size_t s = 0; s < after.places.size(); ++s) {
    EXPECT_NE(after.places[s], before.places[s]);
    EXPECT_EQ(after.models[s], before.models[s]);
  }
}

TEST(WorldParts, SelectedScattersArePlacedAsAmongAll) {
  const World world = three_scatters();
  std::vector<Placement> all, some;
  place_models(world, registry(), {1, 2}, all);
  place_models(world, registry(), {1, 2}, {false, false, true}, some);
  ASSERT_FALSE(some.empty());
  const std::size_t first = all.size() - some.size();
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].index, all[first + i].index);
    EXPECT_EQ(some[i].position, all[first + i].position);
    EXPECT_EQ(some[i].parameters, all[first + i].parameters);
  }
  const std::vector<double> placed = placed_per_block(world, registry());
  // Known counts are not measured again.
  const std::optional<double> known[] = {placed[0] + 1, std::nullopt, std::nullopt};
  const std::vector<double> counted = placed_per_block(world, registry(), known);
  EXPECT_EQ(counted[0], placed[0] + 1);
  EXPECT_EQ(counted[1], placed[1]);
  EXPECT_EQ(counted[2], placed[2]);
}

}  // namespace
}  // namespace psygen::world
