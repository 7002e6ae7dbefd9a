#include "engine/models/terrain/terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "engine/models/kit/packing.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/grid.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models {
namespace {

using core::TerrainVertex;
using test::kFar;
using test::Mesh;
using test::synthesise;

class Terrain : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_terrain_type();
  Parameters paper = default_parameters(*type);

  Parameters at(std::int64_t x, std::int64_t z) const {
    Parameters p = paper;
    p.set_integer(kTerrainBlockX, x);
    p.set_integer(kTerrainBlockZ, z);
    return p;
  }
  std::vector<TerrainVertex> vertices(const Parameters& p, int level) const {
    return synthesise(*type, p, level).vertices<TerrainVertex>();
  }
};

bool same(const TerrainVertex& a, const TerrainVertex& b) {
  return a.height == b.height && a.normal_x == b.normal_x && a.normal_z == b.normal_z;
}

TEST_F(Terrain, OfThePaperHas7938TrianglesWithoutSkirts) {
  EXPECT_EQ(terrain_surface_triangles(paper, 0), 7938u);
  const MeshSize size = type->mesh_size(paper, 0);
  EXPECT_EQ(size.vertex_count, 64u * 64 + 4 * 63);
  EXPECT_EQ(size.triangle_count(), 7938u + 2 * 4 * 63);
  EXPECT_DOUBLE_EQ(type->complexity(paper, 0), 9 * 64 * 64);
  EXPECT_DOUBLE_EQ(terrain_block_size_m(paper), 63);
}

TEST_F(Terrain, KeepsEveryVertexOfACoarserLevelInTheFinerOne) {
  EXPECT_EQ(terrain_strides(64), (std::array<int, 4>{1, 3, 9, 63}));
  EXPECT_EQ(terrain_strides(65), (std::array<int, 4>{1, 4, 16, 64}));
  EXPECT_EQ(terrain_strides(127), (std::array<int, 4>{1, 3, 18, 126}));
  EXPECT_EQ(terrain_strides(128), (std::array<int, 4>{1, 127, 127, 127}));
  for (int size = kMinTerrainSize; size <= kMaxTerrainSize; ++size) {
    const std::array<int, 4> strides = terrain_strides(size);
    EXPECT_EQ(strides[3], size - 1);
    for (std::size_t level = 1; level < 4; ++level)
      EXPECT_EQ(strides[level] % strides[level - 1], 0) << size;
  }
}

test::TerrainOracle oracle_of(const Parameters& p) {
  return {.seed = static_cast<std::uint64_t>(p.integer(kTerrainSeed)),
          .height = p.real(kTerrainHeight),
          .lacunarity = p.real(kTerrainLacunarity),
          .offset = p.real(kTerrainOffset),
          .gain = p.real(kTerrainGain),
          .cells_per_step = p.real(kTerrainCellM) / p.real(kTerrainFeatureM),
          .octaves = static_cast<int>(p.integer(kTerrainOctaves))};
}

// At every level and on every instruction set, to half a step of snorm8 and the change of normals
// by a height error of 1e-5 of the height range.
TEST_F(Terrain, NormalsEqualTheOracleHereAndAtTheEndOfTheWorld) {
  constexpr double kRelief = 120, kCell = 1;
  for (const std::int64_t block : {std::int64_t{0}, std::int64_t{-1}, kFar, -kFar - 1}) {
    const Parameters p = at(block, 5 - block / 2);
    const test::TerrainOracle oracle = oracle_of(p);
    const double metres = kRelief / oracle.max_value();
    for (int level = 0; level < 4; ++level) {
      const TerrainGrid grid(64, level);
      for (const std::string_view target : simd_targets()) {
        pin_simd_target(target);
        const auto mesh = vertices(p, level);
        for (std::uint32_t i = 0; i < grid.surface_vertices(); i += level == 0 ? 97 : 5) {
          const std::int64_t x = p.integer(kTerrainBlockX) * 63 + mesh[i].grid_x,
                             z = p.integer(kTerrainBlockZ) * 63 + mesh[i].grid_z;
          const double dx =
              (oracle.value(x - 1, z) - oracle.value(x + 1, z)) * metres / (2 * kCell);
          const double dz =
              (oracle.value(x, z - 1) - oracle.value(x, z + 1)) * metres / (2 * kCell);
          const double scale = 127 / (std::abs(dx) + 1 + std::abs(dz));
          const double most = 0.5 + 127 * 1e-5 * kRelief / kCell;
          ASSERT_NEAR(mesh[i].normal_x, scale * dx, most) << target << " level " << level;
          ASSERT_NEAR(mesh[i].normal_z, scale * dz, most) << target << " level " << level;
        }
      }
      unpin_simd_target();
    }
  }
}

TEST_F(Terrain, HeightsEqualTheOracleHereAndAtTheEndOfTheWorld) {
  for (const std::int64_t block : {std::int64_t{0}, std::int64_t{-1}, kFar, -kFar - 1}) {
    const Parameters p = at(block, 5 - block / 2);
    const test::TerrainOracle oracle = oracle_of(p);
    const std::vector<TerrainVertex> mesh = vertices(p, 0);
    for (int z = 0; z < 64; z += 7) {
      for (int x = 0; x < 64; x += 5) {
        const double expected =
            oracle.value(p.integer(kTerrainBlockX) * 63 + x, p.integer(kTerrainBlockZ) * 63 + z) /
            oracle.max_value();
        EXPECT_NEAR(mesh[static_cast<std::size_t>(z * 64 + x)].height / 65535.0, expected,
                    1e-5 + 0.5 / 65535);
      }
    }
  }
}

TEST_F(Terrain, NeighboursAgreeBitForBitAlongTheirSeams) {
  for (const auto& [x, z, warp] : {std::tuple{std::int64_t{0}, std::int64_t{0}, 0.0},
                                   {-3, 7, 0.0},
                                   {kFar - 1, -kFar, 0.0},
                                   {kFar - 1, -kFar, 0.4}}) {
    paper.set_real(kTerrainWarp, warp);
    const auto here = vertices(at(x, z), 0), east = vertices(at(x + 1, z), 0),
               south = vertices(at(x, z + 1), 0);
    for (std::size_t i = 0; i < 64; ++i) {
      ASSERT_TRUE(same(here[i * 64 + 63], east[i * 64]));
      ASSERT_TRUE(same(here[63 * 64 + i], south[i]));
    }
  }
}

TEST_F(Terrain, LevelsAgreeBitForBitAtSharedVertices) {
  for (const int size : {64, 65, 62, 128, 5}) {
    Parameters p = at(-9, kFar);
    p.set_integer(kTerrainSize, size);
    p.set_real(kTerrainWarp, size == 65 ? 0.3 : 0);
    const auto fine = vertices(p, 0);
    for (int level = 1; level < type->level_count(); ++level) {
      const TerrainGrid grid(size, level);
      const auto coarse = vertices(p, level);
      for (std::uint32_t v = 0; v < grid.surface_vertices(); ++v) {
        const auto twin = static_cast<std::size_t>(coarse[v].grid_z * size + coarse[v].grid_x);
        ASSERT_TRUE(same(coarse[v], fine[twin])) << size << " level " << level;
      }
    }
  }
}

TEST_F(Terrain, NodesOfHigherLevelsShareHeightsWithTheBlocksBelow) {
  Parameters node = at(-2, 1);
  node.set_integer(kTerrainNodeLevel, 1);
  const auto wide = vertices(node, 0);
  const auto block = vertices(at(-4, 2), 0);  // its first quarter
  for (std::size_t z = 0; z < 32; ++z) {
    for (std::size_t x = 0; x < 32; ++x)
      ASSERT_EQ(wide[z * 64 + x].height, block[2 * z * 64 + 2 * x].height);
  }
  EXPECT_DOUBLE_EQ(terrain_block_size_m(node), 126);
  EXPECT_FLOAT_EQ(type->bounds(node).max.x, 126.0F);
}

TEST_F(Terrain, CoarseHeightsLieOnTheNextLevelsTriangles) {
  Parameters p = at(4, 4);
  for (const int size : {64, 65, 62, 128, 5}) {
    p.set_integer(kTerrainSize, size);
    for (const int level : {0, 2}) {
      const TerrainGrid grid(size, level), next(size, level + 1);
      const auto mesh = vertices(p, level), coarse = vertices(p, level + 1);
      const int ratio = next.stride / grid.stride;
      for (int z = 0; z < grid.n; ++z) {
        for (int x = 0; x < grid.n; ++x) {
          const int cx = std::min(x / ratio, next.n - 2), cz = std::min(z / ratio, next.n - 2);
          const double u = static_cast<double>(x - cx * ratio) / ratio;
          const double v = static_cast<double>(z - cz * ratio) / ratio;
          const auto h = [&](int dx, int dz) {
            return static_cast<double>(
                coarse[static_cast<std::size_t>((cz + dz) * next.n + cx + dx)].height);
          };
          const double plane = u + v <= 1
                                   ? h(0, 0) * (1 - u - v) + h(1, 0) * u + h(0, 1) * v
                                   : h(1, 1) * (u + v - 1) + h(1, 0) * (1 - v) + h(0, 1) * (1 - u);
          ASSERT_NEAR(mesh[static_cast<std::size_t>(z * grid.n + x)].coarse_height, plane, 0.5001);
        }
      }
    }
    for (const TerrainVertex& v : vertices(p, 3))
      EXPECT_EQ(v.coarse_height, v.height);
  }
}

// The surface of a node's mesh of level 1 at a position in its cells, as quantised heights.
double surface_height(const std::vector<TerrainVertex>& mesh, const TerrainGrid& grid, double x,
                      double z) {
  const auto cell = [&](double at) { return std::min(static_cast<int>(at), grid.n - 2); };
  const int cx = cell(x / grid.stride), cz = cell(z / grid.stride);
  const double u = x / grid.stride - cx, v = z / grid.stride - cz;
  const auto h = [&](int dx, int dz) {
    return static_cast<double>(mesh[static_cast<std::size_t>((cz + dz) * grid.n + cx + dx)].height);
  };
  return u + v <= 1 ? h(0, 0) * (1 - u - v) + h(1, 0) * u + h(0, 1) * v
                    : h(1, 1) * (u + v - 1) + h(1, 0) * (1 - v) + h(0, 1) * (1 - u);
}

TEST_F(Terrain, CoarseHeightsOfTheFourChildrenAreTheSurfaceOfTheirParent) {
  for (const int size : {64, 65, 62, 128, 123, 5, 4}) {
    const TerrainGrid grid(size, 1);
    for (const std::int64_t node : {std::int64_t{3}, std::int64_t{-6}, kFar / 2, -kFar / 2 - 1}) {
      for (const int level : {1, 5, 20}) {
        Parameters p = at(node, 7);
        p.set_integer(kTerrainSize, size);
        p.set_integer(kTerrainNodeLevel, level);
        const auto parent = vertices(p, 1);
        for (int child = 0; child < 4; ++child) {
          const int right = child % 2, down = child / 2;
          p.set_integer(kTerrainNodeLevel, level - 1);
          p.set_integer(kTerrainBlockX, 2 * node + right);
          p.set_integer(kTerrainBlockZ, 2 * 7 + down);
          const auto mesh = vertices(p, 1);
          for (std::uint32_t i = 0; i < grid.surface_vertices(); ++i) {
            const double x = (right * (size - 1) + mesh[i].grid_x) / 2.0;
            const double z = (down * (size - 1) + mesh[i].grid_z) / 2.0;
            // Halves are rounded upwards; at the parent's own vertices nothing is rounded.
            ASSERT_EQ(mesh[i].coarse_height, std::floor(surface_height(parent, grid, x, z) + 0.5))
                << size << " level " << level << " child " << child << " vertex " << i;
          }
        }
      }
    }
  }
}

TEST_F(Terrain, CoarseHeightsOfNeighboursAgreeBitForBitAlongTheirSeams) {
  for (const auto& [x, z, level] : {std::tuple{std::int64_t{0}, std::int64_t{-1}, 0},
                                    {-3, 7, 3},
                                    {kFar - 1, -kFar, 0},
                                    {kFar - 1, -kFar, 20}}) {
    paper.set_integer(kTerrainNodeLevel, level);
    const auto here = vertices(at(x, z), 1), east = vertices(at(x + 1, z), 1),
               south = vertices(at(x, z + 1), 1);
    for (std::size_t i = 0; i < 22; ++i) {
      ASSERT_TRUE(same(here[i * 22 + 21], east[i * 22]));
      ASSERT_TRUE(same(here[21 * 22 + i], south[i]));
      ASSERT_EQ(here[i * 22 + 21].coarse_height, east[i * 22].coarse_height);
      ASSERT_EQ(here[21 * 22 + i].coarse_height, south[i].coarse_height);
    }
  }
}

TEST_F(Terrain, NormalsFollowTheSlopesAndPointUp) {
  const auto mesh = vertices(at(2, 3), 0);
  const auto relief = static_cast<float>(paper.real(kTerrainReliefM));
  for (std::size_t z = 1; z < 63; ++z) {
    for (std::size_t x = 1; x < 63; ++x) {
      const auto h = [&](std::size_t i) {
        return static_cast<float>(mesh[i].height) / 65535.0F * relief;
      };
      const std::size_t i = z * 64 + x;
      const glm::vec3 expected =
          glm::normalize(glm::vec3((h(i - 1) - h(i + 1)) / 2, 1.0F, (h(i - 64) - h(i + 64)) / 2));
      const glm::vec3 normal =
          decode_octahedral({mesh[i].normal_x / 127.0F, mesh[i].normal_z / 127.0F});
      ASSERT_GT(normal.y, 0);
      ASSERT_GT(glm::dot(normal, expected), 0.9995F);
    }
  }
}

TEST_F(Terrain, WithItsSkirtsFacesUpAndOutwards) {
  for (int level = 0; level < 4; ++level) {
    const TerrainGrid grid(64, level);
    const Mesh mesh = synthesise(*type, paper, level);
    const auto v = mesh.vertices<TerrainVertex>();
    const auto place = [&](std::uint16_t i) {
      const bool skirt = (v[i].grid_x & core::kTerrainSkirtBit) != 0;
      return glm::vec3(v[i].grid_x & 0x7F,
                       static_cast<float>(v[i].height) / 65535.0F * 120.0F - (skirt ? 20.0F : 0.0F),
                       v[i].grid_z);
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = place(mesh.indices[i]), b = place(mesh.indices[i + 1]),
                      c = place(mesh.indices[i + 2]);
      const glm::vec3 normal = glm::cross(b - a, c - a);
      if (i < 3 * terrain_surface_triangles(paper, level)) {
        ASSERT_GT(normal.y, 0);
      } else {
        const glm::vec3 outward = (a + b + c) / 3.0F - glm::vec3(31.5F, 0, 31.5F);
        ASSERT_GT(normal.x * outward.x + normal.z * outward.z, 0);
      }
    }
    for (std::uint32_t k = 0; k < grid.border_vertices(); ++k) {
      const TerrainVertex& twin = v[grid.border_vertex(k)];
      const TerrainVertex& skirt = v[grid.surface_vertices() + k];
      EXPECT_TRUE(same(twin, skirt));
      EXPECT_EQ(skirt.grid_x, twin.grid_x | core::kTerrainSkirtBit);
      EXPECT_EQ(skirt.grid_z, twin.grid_z);
      EXPECT_EQ(skirt.coarse_height, twin.coarse_height);
    }
  }
}

// As measured: 13.9 µs for a block, 65.7 µs for a node of level 9, about 3 µs for the coarsest mesh
// of either.
TEST_F(Terrain, StepsOfNodesGrowLikeTheirTimes) {
  Parameters far = paper;
  far.set_integer(kTerrainNodeLevel, 9);
  EXPECT_GT(type->steps(far, 0), 4 * type->steps(paper, 0));
  EXPECT_LT(type->steps(far, 0), 6 * type->steps(paper, 0));
  EXPECT_GT(type->steps(paper, 1), type->steps(paper, 0)) << "with the samples of the parent";
  EXPECT_LT(type->steps(far, 3), 2 * type->steps(paper, 3));
  EXPECT_LT(type->steps(paper, 3), type->steps(paper, 0) / 10);
  Parameters shadows = paper;
  shadows.set_real(kTerrainSunElevation, 10);
  EXPECT_GT(type->steps(shadows, 1), type->steps(paper, 1)) << "heights further away";
}

TEST_F(Terrain, LevelErrorIsCloseToTheMeasuredError) {
  for (int level = 1; level < 4; ++level) {
    double largest = 0;
    const TerrainGrid grid(64, level);
    for (std::int64_t block = 0; block < 40; ++block) {
      const Parameters p = at(block * 11, block * 5);
      const auto coarse = vertices(p, level);
      for (const TerrainVertex& v : vertices(p, 0)) {
        if ((v.grid_x & core::kTerrainSkirtBit) != 0) continue;
        const int cx = std::min(v.grid_x / grid.stride, grid.n - 2);
        const int cz = std::min(v.grid_z / grid.stride, grid.n - 2);
        const auto h = [&](int dx, int dz) {
          return static_cast<double>(
              coarse[static_cast<std::size_t>((cz + dz) * grid.n + cx + dx)].height);
        };
        const double x = static_cast<double>(v.grid_x) / grid.stride - cx;
        const double z = static_cast<double>(v.grid_z) / grid.stride - cz;
        const double plane =
            x + z <= 1 ? h(0, 0) + x * (h(1, 0) - h(0, 0)) + z * (h(0, 1) - h(0, 0))
                       : h(1, 1) + (1 - x) * (h(0, 1) - h(1, 1)) + (1 - z) * (h(1, 0) - h(1, 1));
        largest = std::max(largest, std::abs(plane - v.height) / 65535 * 120);
      }
    }
    const double estimate = type->level_error_m(paper, level);
    EXPECT_GT(estimate, largest / 3) << "level " << level << ": measured " << largest;
    EXPECT_LT(estimate, largest * 3) << "level " << level << ": measured " << largest;
  }
}

}  // namespace
}  // namespace psygen::models
