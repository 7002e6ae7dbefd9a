#include "engine/models/terrain/ground.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

class Ground : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_terrain_type();
  Parameters p = default_parameters(*type);
};

TEST_F(Ground, EqualsTheMeshAtItsVerticesAndThePlanesBetween) {
  const core::BlockCoord block{-7, 12};
  p.set_integer(kTerrainBlockX, block.x);
  p.set_integer(kTerrainBlockZ, block.z);
  p.set_real(kTerrainCellM, 1.5);
  const auto mesh = test::synthesise(*type, p, 0).vertices<core::TerrainVertex>();
  const auto height = [&](std::size_t x, std::size_t z) {
    return mesh[z * 64 + x].height / 65535.0 * p.real(kTerrainReliefM);
  };
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 200; ++i) {
    const auto x = static_cast<std::size_t>(random.next_integer(0, 62));
    const auto z = static_cast<std::size_t>(random.next_integer(0, 62));
    const double u = random.next_unit(), v = random.next_unit();
    const double plane =
        u + v <= 1 ? height(x, z) * (1 - u - v) + height(x + 1, z) * u + height(x, z + 1) * v
                   : height(x + 1, z + 1) * (u + v - 1) + height(x + 1, z) * (1 - v) +
                         height(x, z + 1) * (1 - u);
    const double local_x = (static_cast<double>(x) + u) * 1.5;
    const double local_z = (static_cast<double>(z) + v) * 1.5;
    EXPECT_NEAR(ground_height_m(p, block, local_x, local_z), plane, 1e-5);
    EXPECT_NEAR(
        ground_height_m(p, block, static_cast<double>(x) * 1.5, static_cast<double>(z) * 1.5),
        height(x, z), 1e-5);
  }
}

TEST_F(Ground, ContinuesIntoTheNeighbouringBlocks) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  for (const double x : {63.0, 70.25, 126.0, -4.5}) {
    for (const core::BlockCoord block : {core::BlockCoord{0, 0}, {kFar - 2, -kFar}}) {
      EXPECT_EQ(ground_height_m(p, block, x, 8.125),
                ground_height_m(p, {block.x + 1, block.z}, x - 63, 8.125));
      EXPECT_EQ(ground_height_m(p, block, 8.125, x),
                ground_height_m(p, {block.x, block.z + 1}, 8.125, x - 63));
    }
  }
}

TEST_F(Ground, NormalIsTheGradientOfTheHeight) {
  for (int i = 0; i < 50; ++i) {
    // Away from the edges of triangles, in one and the other half of the cell.
    const double inside = i % 2 == 0 ? 0.2 : 0.7;
    const double x = i + inside, z = 62 - i + inside, step = 1e-3;
    GroundPoint ground;
    sample_ground(p, {3, 4}, std::array{glm::dvec2(x, z)}, {&ground, 1});
    const glm::vec3 normal = ground.normal;
    const double dx = (ground_height_m(p, {3, 4}, x + step, z) - ground_height_m(p, {3, 4}, x, z));
    const double dz = (ground_height_m(p, {3, 4}, x, z + step) - ground_height_m(p, {3, 4}, x, z));
    const glm::vec3 expected = glm::normalize(
        glm::vec3(static_cast<float>(-dx / step), 1.0F, static_cast<float>(-dz / step)));
    EXPECT_NEAR(glm::dot(normal, normal), 1, 1e-5);
    EXPECT_GT(glm::dot(normal, expected), 0.99999F);
  }
}

TEST_F(Ground, OfManyPointsEqualsEachPoint) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 63; ++i)
    points.push_back({i * 0.97, 60 - i * 0.53});
  std::vector<GroundPoint> ground(points.size());
  sample_ground(p, {8, -8}, points, ground);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(ground[i].height_m, ground_height_m(p, {8, -8}, points[i].x, points[i].y));
    GroundPoint one;
    sample_ground(p, {8, -8}, {&points[i], 1}, {&one, 1});
    EXPECT_EQ(ground[i].normal, one.normal);
  }
}

// Fails unless both have the same bits.
void expect_same(const GroundPoint& a, const GroundPoint& b) {
  ASSERT_EQ(std::bit_cast<std::uint64_t>(a.height_m), std::bit_cast<std::uint64_t>(b.height_m));
  for (int c = 0; c < 3; ++c)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a.normal[c]), std::bit_cast<std::uint32_t>(b.normal[c]));
}

TEST_F(Ground, OfABlockOrMeshHasTheBitsOfSinglePointsOnEveryTargetAnywhere) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  core::RandomStream random(9, 0, 0, 0, core::Purpose::kPosition);
  for (int trial = 0; trial < 16; ++trial) {
    p = test::random_parameters(*type, random);
    p.set_integer(kTerrainSize, trial == 0 ? 64 : random.next_integer(4, 128));
    p.set_real(kTerrainWarp, trial % 4 == 3 ? 0.3 : 0);
    const core::BlockCoord block =
        trial % 2 == 0 ? core::BlockCoord{kFar - trial / 4, -kFar} : core::BlockCoord{trial, -9};
    const double side = terrain_block_size_m(p);
    // Inside, on vertices and edges, at the far corner and outside.
    std::vector<glm::dvec2> points{{0, 0}, {side, side}, {side, 0}, {-0.1, 3}, {3, side * 1.5}};
    points.push_back({std::nextafter(side, 0.0), std::nextafter(side, 0.0)});
    points.push_back({p.real(kTerrainCellM) * 2, p.real(kTerrainCellM) * 3});
    for (int i = 0; i < 20; ++i)
      points.push_back({side * random.next_unit(), side * random.next_unit()});
    for (const std::string_view target : simd_targets()) {
      pin_simd_target(target);
      p.set_integer(kTerrainBlockX, block.x);
      p.set_integer(kTerrainBlockZ, block.z);
      const test::Mesh mesh = test::synthesise(*type, p, 0);
      const BlockGround whole(p, block, 1000), single(p, block, 0),
          drawn(p, block, mesh.vertex_bytes);
      for (const glm::dvec2& point : points) {
        expect_same(whole.at(point), single.at(point));
        expect_same(drawn.at(point), single.at(point));
      }
      if (HasFatalFailure()) break;
    }
    unpin_simd_target();
    ASSERT_FALSE(HasFatalFailure()) << "trial " << trial;
  }
}

}  // namespace
}  // namespace psygen::models
