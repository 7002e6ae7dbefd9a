// Rays that hit water, and paths through and around it.
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/query/path_finder.hpp"
#include "tests/engine/query/worlds.hpp"
#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::query {
namespace {

using testing::Loaded;
using world::testing::replaced;
using world::testing::river_text;

class WaterQuery : public ::testing::Test {
 protected:
  Loaded loaded_ = Loaded::parsed(river_text());
  World query_{loaded_.world, loaded_.registry};

  core::WorldPosition at(glm::dvec2 at_m, double height_m) const {
    core::WorldPosition place = loaded_.world.position(at_m);
    place.local.y = height_m;
    return place;
  }
};

TEST_F(WaterQuery, AVerticalRayHitsTheSurfaceFromAboveAndFromBelow) {
  int wet = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec2 at_m{1500 + 0.25 * (i % 1500), 1600 + 0.11 * i / 2};
    const auto water = query_.water(at(at_m, 0));
    ASSERT_TRUE(water);
    const auto down = query_.cast({.origin = at(at_m, 200), .water = true});
    ASSERT_TRUE(down);
    if (water->is_dry()) {
      ASSERT_EQ(down->kind, HitKind::kGround);
      continue;
    }
    ++wet;
    ASSERT_EQ(down->kind, HitKind::kWater) << at_m.x << ' ' << at_m.y;
    EXPECT_NEAR(down->distance_m, 200 - water->surface_m, 1e-6);
    EXPECT_EQ(down->water, water->body);
    EXPECT_EQ(down->normal, water->normal);
    EXPECT_FALSE(down->from_inside);
    const auto up = query_.cast({.origin = at(at_m, water->surface_m - water->depth_m / 2),
                                 .direction = {0, 1, 0},
                                 .water = true});
    ASSERT_TRUE(up);
    ASSERT_EQ(up->kind, HitKind::kWater);
    EXPECT_TRUE(up->from_inside);
    EXPECT_NEAR(up->distance_m, water->depth_m / 2, 1e-6);
    const auto ground = query_.cast({.origin = at(at_m, 200)});
    EXPECT_EQ(ground->kind, HitKind::kGround) << "rays pass water by default";
  }
  EXPECT_GT(wet, 500);
}

TEST_F(WaterQuery, ASlantingRayEndsOnTheNearestSurface) {
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kPosition);
  int hits = 0, rivers = 0;
  for (int i = 0; i < 1500; ++i) {
    const glm::dvec3 direction{random.next_real(-1, 1), random.next_real(-0.8, -0.1),
                               random.next_real(-1, 1)};
    const Ray ray{.origin = at({random.next_real(1550, 1900), random.next_real(1580, 1780)},
                               random.next_real(40, 70)),
                  .direction = direction,
                  .longest_m = 400,
                  .water = true};
    const auto hit = query_.cast(ray);
    ASSERT_TRUE(hit);
    if (hit->kind != HitKind::kWater) continue;
    ++hits;
    rivers += hit->water == world::testing::kTheRiver ? 1 : 0;
    const auto water = query_.water(hit->position);
    ASSERT_TRUE(water);
    EXPECT_EQ(water->body, hit->water);
    EXPECT_NEAR(hit->position.local.y, water->surface_m, 1e-6);
    // Before the end there is neither ground nor water.
    Ray dry = ray;
    dry.longest_m = std::numeric_limits<double>::infinity();
    dry.water = false;
    EXPECT_GT(query_.cast(dry)->distance_m, hit->distance_m - 1e-6);
  }
  EXPECT_GT(hits, 400);
  EXPECT_GT(rivers, 5);
}

TEST(EndlessWater, ARayEndsAfterTheMaximumNumberOfBlocks) {
  const Loaded loaded = Loaded::parsed(
      world::testing::replaced(river_text(), "blocks = [48, 48]", "blocks = [0, 0]"));
  World query(loaded.world, loaded.registry);
  const double end_m = static_cast<double>(World::kMaxBlocks) * 64;
  const auto hit = query.cast({.origin = {{0, 0}, {1, 100, 1}},
                               .direction = {1, -1e-5, 0},
                               .longest_m = std::numeric_limits<double>::infinity(),
                               .ground = false,
                               .models = false,
                               .water = true});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->kind, HitKind::kNothing);
  EXPECT_NEAR(hit->distance_m, end_m, 64);
}

TEST_F(WaterQuery, AWorldWithoutWaterHasNoneToHit) {
  const Loaded dry = Loaded::parsed(testing::kBounded);
  World query(dry.world, dry.registry);
  const auto hit = query.cast({.origin = {{2, 2}, {9, 200, 9}}, .water = true});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->kind, HitKind::kGround);
}

TEST_F(WaterQuery, PathsFordShallowBrooksAndAvoidDeepWaterIfAsked) {
  // On both sides of the brook; and of the lake.
  const core::WorldPosition west = at({1760, 1480}, 0), east = at({1690, 1470}, 0);
  PathFinder finder(query_);
  const auto ford = finder.find(east, west);
  ASSERT_GT(ford.size(), 10U);
  bool wet = false;
  for (const auto& point : ford)
    wet = wet || !query_.water(point)->is_dry();
  EXPECT_TRUE(wet);
  EXPECT_TRUE(finder.reaches(east, west));
  const core::WorldPosition north = at({1745, 1600}, 0), south = at({1770, 1740}, 0);
  const auto deepest_m = [&](PathFinder& walker) {
    double deepest = 0;
    for (const auto& point : walker.find(north, south))
      deepest = std::max(deepest, query_.ground(point)->water_depth_m);
    return deepest;
  };
  PathFinder swimmer(query_, {.swim_cost = 1});
  EXPECT_GT(deepest_m(swimmer), 3);
  PathFinder walker(query_, {.swims = false});
  ASSERT_TRUE(walker.reaches(north, south));
  EXPECT_LE(deepest_m(walker), walker.settings().wade_m);
}

TEST_F(WaterQuery, NoPathLeadsThroughAFastCurrent) {
  const std::string text = std::string(world::testing::kBrookLand) +
                           world::testing::replaced(world::testing::kBrookTable, "depth_m = 0.7",
                                                    "depth_m = 0.7\ndischarge_m3_s = 30");
  const Loaded loaded = Loaded::parsed(text);
  World query(loaded.world, loaded.registry);
  const core::WorldPosition west = at({1760, 1480}, 0), east = at({1690, 1470}, 0);
  PathFinder careful(query, {.max_cells = 2500});
  EXPECT_FALSE(careful.reaches(east, west));
  PathFinder reckless(query, {.fastest_m_s = 100, .max_cells = 2500});
  EXPECT_TRUE(reckless.reaches(east, west));
}

TEST_F(WaterQuery, TellsTheDischargeOfRiversAlone) {
  std::size_t rivers = 0, still = 0, dry = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto water = query_.water(at({1500 + 0.25 * (i % 1500), 1600 + 0.11 * i / 2}, 0));
    ASSERT_TRUE(water);
    const bool is_river = water->body >= world::testing::kTheRiver;
    ASSERT_EQ(water->discharge_m3_s.has_value(), is_river);
    ++(water->is_dry() ? dry : is_river ? rivers : still);
  }
  EXPECT_GT(rivers, 30U);
  EXPECT_GT(still, 100U);
  EXPECT_GT(dry, 100U);
}

TEST_F(WaterQuery, TheFirstQuestionFollowsTheWorld) {
  // From block (0, 0) the size of blocks decides which place that is.
  const core::WorldPosition place{{0, 0}, {1960, 0, 1752}};
  const auto before = query_.water(place);
  ASSERT_TRUE(before && before->discharge_m3_s);
  Loaded other =
      Loaded::parsed(replaced(replaced(river_text(), "block_vertices = 65", "block_vertices = 33"),
                              "blocks = [48, 48]", "blocks = [96, 96]"));
  other.world.revision.number = loaded_.world.revision.number + 1;
  std::swap(loaded_, other);
  const auto after = query_.water(place);
  ASSERT_TRUE(after && after->discharge_m3_s);
  EXPECT_NEAR(*after->discharge_m3_s, *before->discharge_m3_s, 0.3 * *before->discharge_m3_s);
}

// Places in the water of rivers, and rays that come down to them from 400 m away.
TEST(WaterQueryOfANetwork, ARayOverDryBlocksFindsTheRiverBeyond) {
  const Loaded loaded = Loaded::parsed(world::testing::network_text());
  const world::World& world = loaded.world;
  World query(world, loaded.registry);
  const double block_m = world.block_size_m();
  constexpr double kAwayM = 400, kUpM = 30;
  int rays = 0, over_dry_blocks = 0;
  for (int i = 0; i < 40'000 && rays < 200; ++i) {
    const core::WorldPosition river = world.position({7.0 * (i % 200), 7.0 * (i / 200)});
    const auto water = query.water(river);
    if (!water || !water->discharge_m3_s) continue;
    const double angle = 0.7 * ++rays;
    const glm::dvec3 from{kAwayM * std::cos(angle), water->surface_m + kUpM,
                          kAwayM * std::sin(angle)};
    Ray ray{.origin = core::normalised({river.block, river.local + from}, block_m),
            .direction = {-from.x, -kUpM, -from.z},
            .longest_m = 2 * kAwayM,
            .ground = false,
            .models = false,
            .water = true};
    const double to_river_m = std::hypot(kAwayM, kUpM);
    const auto hit = query.cast(ray);
    ASSERT_TRUE(hit);
    ASSERT_EQ(hit->kind, HitKind::kWater) << rays;
    ASSERT_LE(hit->distance_m, to_river_m + 0.03) << rays;  // a network rounds places to 1/64 m
    if (hit->distance_m < to_river_m - 1) continue;         // water of another place is nearer
    int dry = 0;
    for (double t = 0; t < kAwayM; t += block_m) {
      const glm::dvec3 at = ray.origin.local + t / kAwayM * ray.direction;
      const core::BlockCoord block = core::normalised({ray.origin.block, at}, block_m).block;
      dry += world.layer()->ground.may_have_water(block, 0, block_m) ? 0 : 1;
    }
    over_dry_blocks += dry >= 3 ? 1 : 0;
  }
  EXPECT_EQ(rays, 200);
  EXPECT_GT(over_dry_blocks, 20);
}

}  // namespace
}  // namespace psygen::query
