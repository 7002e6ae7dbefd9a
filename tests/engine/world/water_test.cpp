#include "engine/world/water.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/models/terrain/ground.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::kSmallWorld;
using testing::parsed;

constexpr double kLevelM = 31.7;  // half of the small world lies lower

World with_sea() {
  return parsed(std::string(kSmallWorld) + "\n[water]\nlevel_m = 31.7\n");
}

// Calls visit(position, height of the ground) for 2,000 places of a small world.
template <class Visit>
void each_place(const World& world, const Visit& visit) {
  core::RandomStream random(11, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 2000; ++i) {
    const core::WorldPosition at{
        {static_cast<std::int32_t>(random.next_integer(0, 7)),
         static_cast<std::int32_t>(random.next_integer(0, 3))},
        {random.next_real(0, 64), random.next_real(-50, 90), random.next_real(0, 64)}};
    visit(at, models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z));
  }
}

TEST(Water, AWorldWithoutASeaIsDryEverywhere) {
  const World world = parsed(kSmallWorld);
  each_place(world, [&](const core::WorldPosition& at, double ground_m) {
    ASSERT_FALSE(water_surface(world, at));
    const WaterPoint point = water_at(world, at);
    ASSERT_TRUE(point.is_dry());
    ASSERT_EQ(point.depth_m, 0);
    ASSERT_EQ(point.surface_m, kDrySurfaceM);
    ASSERT_EQ(surface_height_m(world, at), ground_m);
  });
}

TEST(Water, TheSeaCoversLowerGroundWithStillWater) {
  const World world = with_sea();
  int wet = 0, dry = 0;
  each_place(world, [&](const core::WorldPosition& at, double ground_m) {
    const auto surface = water_surface(world, at);
    ASSERT_TRUE(surface);
    ASSERT_EQ(surface->surface_m, kLevelM);
    ASSERT_EQ(surface->body, kSea);
    const WaterPoint point = water_at(world, at);
    ASSERT_EQ(point.depth_m, std::max(kLevelM - ground_m, 0.0));
    ASSERT_EQ(point.depth_m, water_at(world, at, ground_m).depth_m);
    ASSERT_EQ(point.is_dry(), ground_m >= kLevelM);
    ASSERT_EQ(point.surface_m, ground_m >= kLevelM ? kDrySurfaceM : kLevelM);
    ASSERT_EQ(point.normal, glm::vec3(0, 1, 0));
    ASSERT_EQ(point.flow_m_s, glm::vec2(0.0F));
    ASSERT_EQ(point.foam, 0);
    ASSERT_EQ(surface_height_m(world, at), std::max(ground_m, kLevelM));
    ++(point.is_dry() ? dry : wet);
  });
  EXPECT_GT(wet, 100);
  EXPECT_GT(dry, 100);
}

TEST(Water, GroundAtTheSurfaceIsDry) {
  const World world = with_sea();
  EXPECT_TRUE(water_at(world, {}, kLevelM).is_dry());
  const WaterPoint thin = water_at(world, {}, std::nextafter(kLevelM, 0.0));
  EXPECT_EQ(thin.body, kSea);
  EXPECT_GT(thin.depth_m, 0);
}

TEST(Water, TheSeaReachesBeyondTheBlocksOfABoundedWorld) {
  const World world = with_sea();
  EXPECT_EQ(water_at(world, {{-5, 900}, {}}, -3).depth_m, kLevelM + 3);
}

}  // namespace
}  // namespace psygen::world
