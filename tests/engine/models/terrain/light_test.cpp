#include "engine/models/terrain/light.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/light.hpp"

namespace psygen::models {
namespace {

using core::TerrainVertex;
using test::kFar;

class Light : public ::testing::Test {
 protected:
  ~Light() override { unpin_simd_target(); }

  std::unique_ptr<ModelType> type = make_terrain_type();
  Parameters paper = default_parameters(*type);

  Parameters at(std::int64_t x, std::int64_t z, double azimuth, double elevation) const {
    Parameters p = paper;
    p.set_integer(kTerrainBlockX, x);
    p.set_integer(kTerrainBlockZ, z);
    p.set_real(kTerrainSunAzimuth, azimuth);
    p.set_real(kTerrainSunElevation, elevation);
    return p;
  }
  std::vector<TerrainVertex> surface(const Parameters& p, int level) const {
    auto mesh = test::synthesise(*type, p, level).vertices<TerrainVertex>();
    mesh.resize(TerrainGrid(static_cast<int>(p.integer(kTerrainSize)), level).surface_vertices());
    return mesh;
  }
  test::LightOracle oracle(const Parameters& p) const {
    return {.terrain = {.seed = static_cast<std::uint64_t>(p.integer(kTerrainSeed)),
                        .height = p.real(kTerrainHeight),
                        .lacunarity = p.real(kTerrainLacunarity),
                        .offset = p.real(kTerrainOffset),
                        .gain = p.real(kTerrainGain),
                        .cells_per_step = p.real(kTerrainCellM) / p.real(kTerrainFeatureM),
                        .octaves = static_cast<int>(p.integer(kTerrainOctaves))},
            .cell_m = p.real(kTerrainCellM),
            .relief_m = p.real(kTerrainReliefM),
            .node_level = static_cast<int>(p.integer(kTerrainNodeLevel)),
            .azimuth = p.real(kTerrainSunAzimuth),
            .elevation = p.real(kTerrainSunElevation)};
  }
  // Compares every `step`-th vertex of the mesh, except the first.
  void expect_oracle(const Parameters& p, int level, std::size_t step) const {
    const test::LightOracle expected = oracle(p);
    const std::vector<TerrainVertex> mesh = surface(p, level);
    const std::int64_t cells = p.integer(kTerrainSize) - 1;
    for (std::size_t i = step - 1; i < mesh.size(); i += step) {
      const std::int64_t x = p.integer(kTerrainBlockX) * cells + mesh[i].grid_x;
      const std::int64_t z = p.integer(kTerrainBlockZ) * cells + mesh[i].grid_z;
      const int grid = level < 2 ? 0 : 1;
      ASSERT_NEAR(mesh[i].sun, 255 * expected.sun(grid, x, z), 2) << "vertex " << i;
      ASSERT_NEAR(mesh[i].ambient, 255 * expected.sky(grid, x, z), 2) << "vertex " << i;
    }
  }
};

bool same_light(const TerrainVertex& a, const TerrainVertex& b) {
  return a.sun == b.sun && a.ambient == b.ambient;
}

TEST_F(Light, SinesOfDegreesAreExactEnough) {
  for (double degrees = -720; degrees <= 720; degrees += 0.7) {
    const double radians = degrees * std::acos(-1.0) / 180;
    EXPECT_NEAR(exact_sin_degrees(degrees), std::sin(radians), 3e-15);
    EXPECT_NEAR(exact_cos_degrees(degrees), std::cos(radians), 3e-15);
  }
  EXPECT_EQ(exact_cos_degrees(90), 0);
  EXPECT_EQ(exact_sin_degrees(-180), 0);
}

TEST_F(Light, EqualsTheOracleHereAndAtTheEndOfTheWorld) {
  for (const std::string_view target : simd_targets()) {
    pin_simd_target(target);
    expect_oracle(at(3, -2, 128, 14), 0, 61);
    expect_oracle(at(3, -2, 128, 14), 1, 7);
    expect_oracle(at(3, -2, 128, 14), 2, 5);
    expect_oracle(at(kFar, -kFar - 1, 301, 30), 1, 11);
  }
}

TEST_F(Light, EqualsTheOracleForOtherSizesNodesAndSuns) {
  for (const auto& [size, node_level, azimuth, elevation] : {std::tuple{65, 0, 10.0, 3.0},
                                                             {62, 1, 200.0, 44.0},
                                                             {128, 0, -75.0, 8.0},
                                                             {5, 0, 0.0, 20.0},
                                                             {64, 4, 45.0, 6.0},
                                                             {123, 20, 90.0, 1.0}}) {
    Parameters p = at(-7, 5, azimuth, elevation);
    p.set_integer(kTerrainSize, size);
    p.set_integer(kTerrainNodeLevel, node_level);
    for (int level = 0; level < 3; ++level) {
      SCOPED_TRACE(size * 10 + level);
      expect_oracle(p, level, level == 0 ? 83 : 9);
    }
  }
}

TEST_F(Light, NeighboursAgreeBitForBitAlongTheirSeams) {
  for (const auto& [x, z, node_level, size] : {std::tuple{std::int64_t{0}, std::int64_t{-1}, 0, 64},
                                               {-3, 7, 0, 65},
                                               {-3, 7, 2, 62},
                                               {kFar - 1, -kFar, 0, 128},
                                               {kFar - 1, -kFar, 20, 64}}) {
    paper.set_integer(kTerrainNodeLevel, node_level);
    paper.set_integer(kTerrainSize, size);
    for (int level = 0; level < 4; ++level) {
      const auto n = static_cast<std::size_t>(TerrainGrid(size, level).n);
      const auto here = surface(at(x, z, 77, 9), level), east = surface(at(x + 1, z, 77, 9), level),
                 south = surface(at(x, z + 1, 77, 9), level);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_TRUE(same_light(here[i * n + n - 1], east[i * n])) << size << " level " << level;
        ASSERT_TRUE(same_light(here[(n - 1) * n + i], south[i])) << size << " level " << level;
      }
    }
  }
}

TEST_F(Light, OfTheFirstTwoLevelsIsTheSameAtSharedVertices) {
  for (const int size : {64, 65, 128}) {
    Parameters p = at(12, 5, 140, 15);
    p.set_integer(kTerrainSize, size);
    const auto fine = surface(p, 0);
    for (const TerrainVertex& v : surface(p, 1))
      ASSERT_TRUE(same_light(v, fine[static_cast<std::size_t>(v.grid_z * size + v.grid_x)]));
  }
}

TEST_F(Light, OfFlatGroundIsFull) {
  paper.set_real(kTerrainReliefM, 0.01);
  for (const double elevation : {90.0, 45.0, 3.0}) {
    for (const int node_level : {0, 3}) {
      paper.set_integer(kTerrainNodeLevel, node_level);
      for (const TerrainVertex& v : surface(at(5, 5, 30, elevation), 0)) {
        ASSERT_EQ(v.sun, 255) << elevation;
        ASSERT_EQ(v.ambient, 255) << elevation;
      }
    }
  }
}

TEST_F(Light, FromOverheadCastsNoShadowsAndFromBelowTheHorizonLightsNothing) {
  for (int level = 0; level < 4; ++level) {
    for (const TerrainVertex& v : surface(at(2, 9, 30, 90), level))
      ASSERT_EQ(v.sun, 255);
    for (const double elevation : {0.0, -20.0}) {
      for (const TerrainVertex& v : surface(at(2, 9, 30, elevation), level))
        ASSERT_EQ(v.sun, 0);
    }
  }
}

TEST_F(Light, HillsShadowTheGroundBehindThem) {
  std::size_t lit = 0, not_lit = 0, dark = 0, not_dark = 0, behind = 0;
  for (std::int64_t block = 0; block < 80; ++block) {
    const auto east = surface(at(block, 3, 90, 12), 1), west = surface(at(block, 3, 270, 12), 1);
    for (std::size_t i = 0; i < east.size(); ++i) {
      const float to_east = static_cast<float>(east[i].normal_x) / 127.0F;
      if (to_east > 0.3F) ++(east[i].sun > 200 ? lit : not_lit);
      if (to_east < -0.3F) ++(east[i].sun < 50 ? dark : not_dark);
      // Not because the ground faces away: a hill is in between.
      if (to_east > 0 && east[i].sun < 50 && west[i].sun > 50) ++behind;
    }
  }
  EXPECT_GT(lit, 10 * not_lit);
  EXPECT_GT(dark, 10 * not_dark);
  EXPECT_GT(behind, 50U);
}

TEST_F(Light, OfTheSkyIsWeakerInHollowsThanOnHumps) {
  double sums[2] = {};
  double counts[2] = {};
  for (std::int64_t block = 0; block < 80; ++block) {
    const auto mesh = surface(at(block * 3, 11, 0, 90), 1);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const std::size_t x = i % 22, z = i / 22;
      if (x < 3 || z < 3 || x > 18 || z > 18) continue;
      const double around =
          (mesh[i - 3].height + mesh[i + 3].height + mesh[i - 66].height + mesh[i + 66].height) /
          4.0;
      if (std::abs(around - mesh[i].height) < 500) continue;  // 0.9 m
      const std::size_t kind = mesh[i].height > around ? 1 : 0;
      sums[kind] += mesh[i].ambient;
      counts[kind] += 1;
    }
  }
  ASSERT_GT(counts[0], 100);
  ASSERT_GT(counts[1], 100);
  EXPECT_GT(sums[1] / counts[1], sums[0] / counts[0] + 10);
}

TEST_F(Light, DoesNotMoveTheGround) {
  const auto with = surface(at(4, 4, 128, 20), 0), without = surface(at(4, 4, 0, 90), 0);
  for (std::size_t i = 0; i < with.size(); ++i) {
    ASSERT_EQ(with[i].height, without[i].height);
    ASSERT_EQ(with[i].coarse_height, without[i].coarse_height);
    ASSERT_EQ(with[i].ambient, without[i].ambient);
  }
}

}  // namespace
}  // namespace psygen::models
