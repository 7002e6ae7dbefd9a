// Instances in and beside water.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/world/river_world.hpp"

namespace psygen::world {
namespace {

using testing::kBrookLand;
using testing::parsed;
using testing::registry;
using testing::river_text;

constexpr const char* kRocks = "[[scatter]]\nmodel = \"rock\"\ncount = 300\n";
constexpr const char* kFewRocks = "[[scatter]]\nmodel = \"rock\"\ncount = 30\n";
constexpr const char* kNetwork =
    "[rivers]\nroot_spacing_m = 1024\nhalvings = 5\nsea_share = 0\nchannel_km2 = 0.01\n";

// Calls visit(position in the world, water there) for all instances of some blocks by the water.
template <class Visit>
std::size_t each_instance(const World& world, const Visit& visit) {
  std::size_t count = 0;
  std::vector<Placement> placements;
  for (std::int32_t z = 25; z < 28; ++z) {
    for (std::int32_t x = 24; x < 32; ++x) {
      place_models(world, registry(), {x, z}, placements);
      for (const Placement& p : placements) {
        const core::WorldPosition at{{x, z}, glm::dvec3(p.position)};
        visit(at, water_at(world, at));
        ++count;
      }
    }
  }
  return count;
}

TEST(WaterPlacement, NothingGrowsInRiversAndLakesButAsBeforeInTheSea) {
  const World before = parsed(std::string(kBrookLand) + kRocks);
  const World world = parsed(river_text() + kRocks);
  std::size_t in_sea = 0, in_bodies = 0, sea_before = 0;
  const std::size_t all = each_instance(world, [&](const auto&, const WaterPoint& water) {
    in_bodies += !water.is_dry() && water.body != kSea && water.depth_m > 1e-5 ? 1 : 0;
    in_sea += water.body == kSea ? 1 : 0;
  });
  const std::size_t all_before = each_instance(
      before, [&](const auto&, const WaterPoint& water) { sea_before += water.is_dry() ? 0 : 1; });
  EXPECT_EQ(all_before, 24U * 300);
  EXPECT_LT(all, all_before - 200);
  EXPECT_GT(in_sea, 1000U);
  EXPECT_GE(sea_before, in_sea);
  EXPECT_EQ(in_bodies, 0U);
}

TEST(WaterPlacement, InstancesThatRemainKeepTheirPlaces) {
  const World before = parsed(std::string(kBrookLand) + kRocks);
  const World world = parsed(river_text() + kRocks);
  std::vector<Placement> was, is;
  place_models(before, registry(), {28, 26}, was);
  place_models(world, registry(), {28, 26}, is);
  EXPECT_LT(is.size(), was.size());
  for (const Placement& p : is) {
    const auto same = std::ranges::find(was, p.index, &Placement::index);
    ASSERT_NE(same, was.end());
    EXPECT_EQ(same->position.x, p.position.x);
    EXPECT_EQ(same->position.z, p.position.z);
    EXPECT_EQ(same->parameters, p.parameters);
  }
}

TEST(WaterPlacement, MaxDepthLetsInstancesStandInShallowWaterOfAnyBody) {
  const World world = parsed(river_text() + kRocks + "max_depth_m = 0.5\n");
  std::size_t shallow = 0, in_bodies = 0;
  each_instance(world, [&](const auto&, const WaterPoint& water) {
    ASSERT_LE(water.depth_m, 0.5 + 1e-6);
    shallow += water.is_dry() ? 0 : 1;
    in_bodies += !water.is_dry() && water.body != kSea ? 1 : 0;
  });
  EXPECT_GT(shallow, 100U);
  EXPECT_GT(in_bodies, 20U);
}

// True if there is water within 6 m of a place.
bool is_near_water(const World& world, const core::WorldPosition& at) {
  for (int i = 0; i < 72 * 12; ++i) {
    core::WorldPosition beside = at;
    const double angle = (i % 72) * 5 * 3.14159265358979 / 180, away = 0.5 * (i / 72 + 1);
    beside.local.x += away * std::cos(angle);
    beside.local.z += away * std::sin(angle);
    if (!water_at(world, core::normalised(beside, 64)).is_dry()) return true;
  }
  return false;
}

TEST(WaterPlacement, NearWaterKeepsInstancesAtTheShore) {
  for (const std::string& text :
       {river_text() + kRocks, std::string(kBrookLand) + kNetwork + kFewRocks}) {
    const World world = parsed(text + "near_water_m = 6\nmax_depth_m = 0\n");
    std::size_t far = 0;
    const std::size_t all =
        each_instance(world, [&](const core::WorldPosition& at, const auto& here) {
          ASSERT_TRUE(here.is_dry());
          far += is_near_water(world, at) ? 0 : 1;
        });
    EXPECT_LE(far, 3U) << "at the very border of the rounding";
    const std::uint32_t count = world.scatter[0].count;
    EXPECT_GT(all, 4 * count);
    EXPECT_LT(all, 22 * count);
  }
}

TEST(WaterPlacement, BlocksAreKnownToBeFarFromRiversAndLakes) {
  for (const std::string& text : {river_text(), std::string(kBrookLand) + kNetwork}) {
    const World world = parsed(text);
    const models::GroundStack& ground = world.shaped.layer->ground;
    std::size_t without = 0, dry = 0, wet = 0;
    for (const double margin_m : {0.0, 6.0, 40.0}) {
      for (std::int32_t i = 0; i < 144; ++i) {
        const core::BlockCoord block{20 + i % 12, 18 + i / 12};
        const bool may = ground.may_have_water(block, margin_m, 64);
        const int steps = static_cast<int>((64 + 2 * margin_m) / 4);
        bool any = false;
        for (int k = 0; k <= (steps + 1) * (steps + 1) - 1 && !any; ++k) {
          const glm::dvec2 local = glm::dvec2(k % (steps + 1), k / (steps + 1)) * 4.0 - margin_m;
          const auto at = core::normalised({block, {local.x, 0, local.y}}, 64);
          any = ground.water_over(at.block, {at.local.x, at.local.z}, 64).has_value();
        }
        ASSERT_TRUE(may || !any) << block.x << " " << block.z << " " << margin_m;
        without += may ? 0 : 1;
        dry += any ? 0 : 1;
        wet += any ? 1 : 0;
      }
    }
    EXPECT_GT(wet, 40U);
    EXPECT_GT(2 * without, dry) << without << " of " << dry;
  }
}

TEST(WaterPlacement, KeysReadBackEqual) {
  const World world =
      parsed(std::string(kBrookLand) + kRocks + "near_water_m = 6.5\nmax_depth_m = 0.25\n");
  EXPECT_EQ(world.scatter[0].near_water_m, 6.5);
  EXPECT_EQ(world.scatter[0].max_depth_m, 0.25);
  EXPECT_TRUE(world.scatter[0].has_filter());
  const std::string text = write_world(world, registry());
  EXPECT_EQ(parsed(text), world);
  EXPECT_EQ(write_world(parsed(std::string(kBrookLand) + kRocks), registry()).find("max_depth_m"),
            std::string::npos);
}

}  // namespace
}  // namespace psygen::world
