#include "engine/world/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::kSmallWorld;
using testing::parsed;
using testing::replaced;

TEST(World, ABlockIsOneCellLessWideThanItsVertices) {
  const World world = parsed(kSmallWorld);
  EXPECT_DOUBLE_EQ(world.cell_m(), 2);
  EXPECT_DOUBLE_EQ(world.block_size_m(), 64);
}

TEST(World, AFiniteWorldHasItsBlocksAndNoOthers) {
  const World world = parsed(kSmallWorld);
  EXPECT_FALSE(world.is_endless());
  EXPECT_TRUE(world.contains({0, 0}));
  EXPECT_TRUE(world.contains({7, 3}));
  EXPECT_FALSE(world.contains({8, 3}));
  EXPECT_FALSE(world.contains({7, 4}));
  EXPECT_FALSE(world.contains({-1, 0}));
}

TEST(World, AnEndlessWorldHasEveryBlock) {
  const World world = parsed(replaced(kSmallWorld, "[8, 4]", "[0, 0]"));
  EXPECT_TRUE(world.is_endless());
  EXPECT_TRUE(world.contains({INT32_MIN, INT32_MAX}));
  const World strip = parsed(replaced(kSmallWorld, "[8, 4]", "[0, 4]"));
  EXPECT_TRUE(strip.contains({INT32_MIN, 3}));
  EXPECT_FALSE(strip.contains({0, 4}));
}

TEST(World, MetresAreTheInverseOfAPosition) {
  const World world = parsed(replaced(kSmallWorld, "[8, 4]", "[0, 0]"));
  for (const glm::dvec2 at_m : {glm::dvec2(0, 0), glm::dvec2(70.5, 3), glm::dvec2(-0.25, 1e6)}) {
    EXPECT_EQ(world.metres(world.position(at_m)), at_m);
    const core::WorldPosition raw{{1, -2}, {at_m.x, 9, at_m.y}};
    EXPECT_EQ(world.metres(raw), at_m + glm::dvec2(64, -128));
  }
}

TEST(Sky, TheSunHasItsAzimuthAndElevation) {
  Sky sky;
  sky.sun_azimuth_deg = 90;
  sky.sun_elevation_deg = 30;
  const glm::vec3 east = sky.sun_direction();
  EXPECT_NEAR(glm::length(east), 1, 1e-6);
  EXPECT_NEAR(east.x, std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(east.y, 0.5, 1e-6);
  EXPECT_NEAR(east.z, 0, 1e-6);
  sky.sun_azimuth_deg = 0;
  EXPECT_LT(sky.sun_direction().z, -0.8F);
}

TEST(Sky, AtTheVisibilityTwoPercentOfTheContrastAreLeft) {
  Sky sky;
  sky.visibility_m = 5000;
  EXPECT_NEAR(std::exp(-sky.haze_density() * 5000), 0.02, 1e-4);
}

TEST(World, TheShoreOfItsWaterIsSand) {
  World world;
  world.palette.sand_end_m = 3;
  EXPECT_EQ(drawn_palette(world), world.palette) << "no water";
  world.water.level_m = 10;
  world.water.shore_m = 2;
  EXPECT_EQ(drawn_palette(world).sand_end_m, 12);
  world.water.level_m = 0;
  EXPECT_EQ(drawn_palette(world), world.palette) << "sand reaches higher than the shore";
}

}  // namespace
}  // namespace psygen::world
