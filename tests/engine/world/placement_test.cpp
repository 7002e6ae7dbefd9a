#include "engine/world/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/models/grass/grass.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::kSmallWorld;
using testing::parsed;
using testing::registry;
using testing::replaced;

constexpr core::BlockCoord kBlocks[] = {
    {0, 0}, {7, 3}, {-5, 12}, {INT32_MAX, INT32_MIN}, {1 << 30, -(1 << 30)}};

std::vector<Placement> placed(const World& world, core::BlockCoord block) {
  std::vector<Placement> out;
  place_models(world, registry(), block, out);
  return out;
}

// The normal of the ground under a place, in metres from the corner of a block.
glm::vec3 ground_normal(const World& world, core::BlockCoord block, const glm::vec3& at_m) {
  const glm::dvec2 xz(double{at_m.x}, double{at_m.z});
  models::GroundPoint ground;
  models::sample_ground(world.terrain, block, {&xz, 1}, {&ground, 1});
  return ground.normal;
}

std::string filtered(std::string_view filters) {
  return std::string(kSmallWorld) + std::string(filters);
}

TEST(Placement, EveryBlockHasExactlyItsModels) {
  const World world = parsed(kSmallWorld);
  EXPECT_EQ(models_per_block(world), 8U);
  for (const core::BlockCoord block : kBlocks) {
    const std::vector<Placement> models = placed(world, block);
    ASSERT_EQ(models.size(), 8U);
    for (std::uint32_t i = 0; i < 8; ++i) {
      EXPECT_EQ(models[i].index, i);
      EXPECT_EQ(models[i].model, world.scatter[i < 3 ? 0 : 1].model);
    }
  }
}

TEST(Placement, ModelsStandOnTheGroundOfTheirBlock) {
  const World world = parsed(kSmallWorld);
  for (const core::BlockCoord block : kBlocks) {
    for (const Placement& p : placed(world, block)) {
      EXPECT_GE(p.position.x, 0);
      EXPECT_LT(p.position.x, world.block_size_m());
      EXPECT_GE(p.position.z, 0);
      EXPECT_LT(p.position.z, world.block_size_m());
      EXPECT_FLOAT_EQ(p.position.y, static_cast<float>(models::ground_height_m(
                                        world.terrain, block, static_cast<double>(p.position.x),
                                        static_cast<double>(p.position.z))));
    }
  }
}

TEST(Placement, IsThePureFunctionOfWorldAndBlock) {
  const World world = parsed(kSmallWorld);
  std::vector<Placement> reused(100);
  for (const core::BlockCoord block : kBlocks) {
    const std::vector<Placement> first = placed(world, block);
    place_models(world, registry(), block, reused);
    ASSERT_EQ(first.size(), reused.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].position, reused[i].position);
      EXPECT_EQ(first[i].parameters, reused[i].parameters);
    }
  }
}

TEST(Placement, BlocksInstancesAndSeedsDiffer) {
  std::set<std::uint64_t> hashes;
  std::set<float> places;
  std::size_t count = 0;
  for (const char* seed : {"seed = 5", "seed = 6"}) {
    const World world = parsed(replaced(kSmallWorld, "seed = 5", seed));
    for (const core::BlockCoord block : kBlocks) {
      for (const Placement& p : placed(world, block)) {
        hashes.insert(p.parameters.hash());
        places.insert(p.position.x);
        ++count;
      }
    }
  }
  EXPECT_EQ(hashes.size(), count);
  EXPECT_EQ(places.size(), count);
}

TEST(Placement, ParametersLieInTheirRangesAndFillThem) {
  const World world = parsed(replaced(kSmallWorld, "count = 3", "count = 500"));
  std::map<std::int64_t, int> iterations;
  double lowest = 1e9, highest = 0;
  for (const Placement& p : placed(world, {2, 2})) {
    EXPECT_TRUE(models::validate(registry()[p.model], p.parameters).has_value());
    if (p.model != world.scatter[0].model) {
      EXPECT_EQ(p.parameters.integer(models::kRockSubdivisions), 1);
      continue;
    }
    ++iterations[p.parameters.integer(models::kTreeIterations)];
    lowest = std::min(lowest, p.parameters.real(models::kTreeSizeM));
    highest = std::max(highest, p.parameters.real(models::kTreeSizeM));
  }
  ASSERT_EQ(iterations.size(), 2U);
  EXPECT_NEAR(iterations[2], 250, 60);
  EXPECT_NEAR(iterations[3], 250, 60);
  EXPECT_GE(lowest, 1.5);
  EXPECT_LT(lowest, 1.52);
  EXPECT_LE(highest, 2.5);
  EXPECT_GT(highest, 2.48);
}

TEST(Placement, AChangedRangeAffectsNoOtherParametersOrPositions) {
  const World before = parsed(kSmallWorld);
  const World after = parsed(replaced(kSmallWorld, "iterations = [2, 3]", "iterations = 4"));
  const std::vector<Placement> a = placed(before, {3, 1}), b = placed(after, {3, 1});
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].parameters.real(models::kTreeSizeM), b[i].parameters.real(models::kTreeSizeM));
    EXPECT_EQ(a[i].parameters.integer(0), b[i].parameters.integer(0));
  }
}

TEST(Placement, PlacesAreSpreadEvenlyOverTheBlock) {
  const World world = parsed(replaced(kSmallWorld, "count = 5", "count = 4000"));
  int quadrants[4] = {};
  for (const Placement& p : placed(world, {1, 1}))
    ++quadrants[(p.position.x < 32 ? 0 : 1) + (p.position.z < 32 ? 0 : 2)];
  for (const int count : quadrants)
    EXPECT_NEAR(count, 1000, 120);
}

TEST(Placement, FiltersAreObeyedAndModelsMoveToAllowedPlaces) {
  const World world = parsed(replaced(filtered("min_height_m = 8\nmax_height_m = 40\n"
                                               "max_slope_deg = 30\n"),
                                      "count = 5", "count = 50"));
  std::size_t found = 0;
  for (std::int32_t x = 0; x < 10; ++x) {
    for (const Placement& p : placed(world, {x, 0})) {
      if (p.index < 3) continue;
      ++found;
      EXPECT_GE(p.position.y, 8 - 1e-4);
      EXPECT_LE(p.position.y, 40 + 1e-4);
      const glm::vec3 normal = ground_normal(world, {x, 0}, p.position);
      EXPECT_GE(normal.y, std::cos(30 * 3.14159265 / 180) - 1e-5);
    }
  }
  EXPECT_GT(found, 400U);
}

TEST(Placement, WithoutAnAllowedPlaceAnInstanceIsLeftOutAndTheOthersKeepTheirIndices) {
  const World all = parsed(kSmallWorld);
  const World some = parsed(replaced(kSmallWorld, "count = 3", "count = 3\nmin_height_m = 9999"));
  const std::vector<Placement> a = placed(all, {4, 2}), b = placed(some, {4, 2});
  ASSERT_EQ(b.size(), 5U);
  for (std::size_t i = 0; i < b.size(); ++i) {
    EXPECT_EQ(b[i].index, a[i + 3].index);
    EXPECT_EQ(b[i].position, a[i + 3].position);
    EXPECT_EQ(b[i].parameters, a[i + 3].parameters);
  }
}

TEST(Placement, GrassFollowsTheSlopeOfTheGround) {
  const World world = parsed(filtered("[[scatter]]\nmodel = \"grass\"\ncount = 20\n"));
  bool sloping = false;
  for (const core::BlockCoord block : kBlocks) {
    const std::vector<Placement> models = placed(world, block);
    ASSERT_EQ(models.size(), 28U);
    for (std::size_t i = 8; i < models.size(); ++i) {
      const Placement& p = models[i];
      const glm::vec3 normal = ground_normal(world, block, p.position);
      const double x = p.parameters.real(models::kGrassSlopeX);
      const double z = p.parameters.real(models::kGrassSlopeZ);
      EXPECT_FLOAT_EQ(static_cast<float>(x), std::clamp(-normal.x / normal.y, -1.5F, 1.5F));
      EXPECT_FLOAT_EQ(static_cast<float>(z), std::clamp(-normal.z / normal.y, -1.5F, 1.5F));
      sloping = sloping || std::abs(x) > 0.1;
    }
  }
  EXPECT_TRUE(sloping);
}

TEST(Placement, AWorldWithoutModelsHasEmptyBlocks) {
  const World world = parsed("format = 1\n[world]\nname = \"w\"\nseed = 1\nblocks = [1, 1]\n");
  EXPECT_EQ(models_per_block(world), 0U);
  EXPECT_TRUE(placed(world, {0, 0}).empty());
}

TEST(Placement, TerrainParametersCarrySeedAndBlock) {
  const World world = parsed(kSmallWorld);
  const models::Parameters p = terrain_parameters(world, {-3, INT32_MAX});
  EXPECT_EQ(p.integer(models::kTerrainSeed), 5);
  EXPECT_EQ(p.integer(models::kTerrainBlockX), -3);
  EXPECT_EQ(p.integer(models::kTerrainBlockZ), INT32_MAX);
  EXPECT_EQ(p.integer(models::kTerrainNodeLevel), 0);
  EXPECT_TRUE(models::validate(registry()[world.terrain_model], p).has_value());
}

models::Parameters lit(double azimuth, double elevation) {
  models::Parameters p = parsed(kSmallWorld).terrain;
  set_sun(p, azimuth, elevation);
  return p;
}

TEST(Placement, ShadowsFollowTheSunInSteps) {
  World world = parsed(kSmallWorld);
  world.sky.sun_azimuth_deg = 127.2;
  world.sky.sun_elevation_deg = 43.6;
  const models::Parameters p = terrain_parameters(world, {0, 0});
  EXPECT_EQ(p.real(models::kTerrainSunAzimuth), 128);
  EXPECT_EQ(p.real(models::kTerrainSunElevation), 44);
  world.sky.sun_azimuth_deg = 128.9;
  world.sky.sun_elevation_deg = 44.4;
  EXPECT_EQ(terrain_parameters(world, {0, 0}), p);
  world.sky.sun_azimuth_deg = 129.1;
  EXPECT_NE(terrain_parameters(world, {0, 0}), p);
}

TEST(Placement, TheSameSunIsTheSameTerrain) {
  EXPECT_EQ(lit(-10, 30), lit(350, 30));
  EXPECT_EQ(lit(359.5, 30), lit(0, 30));
  EXPECT_EQ(lit(40, -3), lit(200, -80));
  EXPECT_EQ(lit(40, 0.3), lit(200, -80));
  EXPECT_EQ(lit(40, 89.8), lit(200, 90));
  EXPECT_NE(lit(40, 89), lit(40, 90));
  EXPECT_NE(lit(40, 1), lit(40, 0));
  for (const double azimuth : {-360.0, -359.5, -0.5, 0.0, 359.0, 360.0}) {
    const models::Parameters p = lit(azimuth, 20);
    EXPECT_TRUE(models::validate(*models::make_terrain_type(), p).has_value()) << azimuth;
  }
}

TEST(Placement, OfModelsDoesNotDependOnTheSun) {
  World morning = parsed(kSmallWorld), noon = morning;
  morning.sky.sun_elevation_deg = 5;
  morning.terrain = terrain_parameters(morning, {0, 0});
  noon.sky.sun_elevation_deg = 80;
  noon.terrain = terrain_parameters(noon, {0, 0});
  const auto a = placed(morning, {3, 4}), b = placed(noon, {3, 4});
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].parameters, b[i].parameters);
  }
}

TEST(Placement, ScatterParametersAreTheLowEnds) {
  const World world = parsed(kSmallWorld);
  const models::Parameters p = scatter_parameters(registry(), world.scatter[0]);
  EXPECT_EQ(p.integer(models::kTreeIterations), 2);
  EXPECT_EQ(p.real(models::kTreeSizeM), 1.5);
}

}  // namespace
}  // namespace psygen::world
