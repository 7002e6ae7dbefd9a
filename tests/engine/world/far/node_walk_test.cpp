#include "engine/world/far/node_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/models/terrain/grid.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

class NodeWalkOver : public ::testing::TestWithParam<const char*> {
 protected:
  const World world_ = testing::parsed(std::string(testing::kSmallWorld) + GetParam());
};
INSTANTIATE_TEST_SUITE_P(Ground, NodeWalkOver,
                         ::testing::Values("", "\n[erosion]\nstrength = 0.5\ngully_m = 30\n"),
                         [](const auto& ground) {
                           return *ground.param == 0 ? "plain" : "eroded";
                         });

TEST_P(NodeWalkOver, VisitsEveryBlockOfANodeOnce) {
  const World& world = world_;
  for (int level = 1; level <= 5; ++level) {
    const NodeWalk walk(world, {-3, 2}, level);
    std::set<core::BlockCoord> blocks;
    std::uint32_t tiles = 0;
    const std::int32_t side = 1 << level;
    for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
      const NodeBlock block = walk.block(i);
      blocks.insert(block.coord);
      EXPECT_GE(block.coord.x, -3 * side);
      EXPECT_LT(block.coord.x, -2 * side);
      EXPECT_GE(block.coord.z, 2 * side);
      EXPECT_LT(block.coord.z, 3 * side);
      EXPECT_EQ(block.in_node_m.x, (block.coord.x + 3 * side) * world.block_size_m());
      EXPECT_LT(block.in_tile_m.x, std::ldexp(world.block_size_m(), tile_level(world, level)));
      tiles += walk.starts_tile(i) ? 1 : 0;
      EXPECT_EQ(walk.starts_tile(i), block.in_tile_m == glm::dvec2(0));
    }
    EXPECT_EQ(blocks.size(), static_cast<std::size_t>(side * side));
    EXPECT_EQ(tiles, ground_tiles(world, level));
    EXPECT_LE(tiles, world.has_costly_heights() && level > 2 ? 4U : 16U);
  }
}

// The vertices of a tile's lattice are those of the blocks, at any distance from the origin.
TEST(NodeWalk, FindsTheGroundOfTheBlocksUnderItsTiles) {
  const World world = testing::parsed(testing::kSmallWorld);
  for (const int level : {2, 3, 4}) {
    const NodeWalk walk(world, {INT32_MAX >> level, INT32_MIN >> level}, level);
    std::optional<models::BlockGround> ground;
    for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
      if (walk.starts_tile(i)) walk.make_ground(i, 10'000, ground);
      const NodeBlock block = walk.block(i);
      const glm::dvec2 at = glm::dvec2(16, 8) * world.cell_m();
      const models::GroundPoint tile = ground->at(block.in_tile_m + at);
      EXPECT_EQ(tile.height_m, models::ground_height_m(world.terrain, block.coord, at.x, at.y));
    }
  }
}

// The height of a node's drawn mesh on its triangle, at a point in fractions of its side.
double height_of_mesh(const models::test::Mesh& mesh, const models::TerrainGrid& grid,
                      double relief_m, glm::dvec2 place) {
  const auto vertices = mesh.vertices<core::TerrainVertex>();
  const glm::dvec2 cells = place * static_cast<double>(grid.n - 1);
  const glm::dvec2 first = glm::floor(cells), part = cells - first;
  const auto height = [&](double x, double z) {
    const auto i = static_cast<std::size_t>(first.x + x + (first.y + z) * grid.n);
    return vertices[i].height / 65535.0 * relief_m;
  };
  const double a = height(1, 0), b = height(0, 1);  // the diagonal
  if (part.x + part.y <= 1) return height(0, 0) * (1 - part.x - part.y) + a * part.x + b * part.y;
  return height(1, 1) * (part.x + part.y - 1) + a * (1 - part.y) + b * (1 - part.x);
}

TEST(NodeWalk, FindsTheGroundThatIsDrawn) {
  for (const char* file : {"paper.toml", "silver_combe.toml", "watershed.toml"}) {
    models::Registry registry = models::make_standard_registry();
    const auto world = load_world(testing::game_file("worlds") / file, registry);
    ASSERT_TRUE(world);
    const models::ModelType& type = registry[world->terrain_model];
    const int mesh_level = node_mesh_level(*world);
    for (const int level : {1, 3, 5}) {
      const core::BlockCoord node{5, 7};
      models::Parameters p = terrain_parameters(*world, node);
      p.set_integer(models::kTerrainNodeLevel, level);
      const models::test::Mesh mesh = models::test::synthesise(type, p, mesh_level);
      const models::TerrainGrid grid(static_cast<int>(p.integer(models::kTerrainSize)), mesh_level);
      const NodeWalk walk(*world, node, level);
      EXPECT_EQ(walk.drawn_stride(), grid.stride);
      const models::BlockGround ground = walk.whole_ground(nullptr);
      const double side_m = std::ldexp(world->block_size_m(), level);
      for (int i = 0; i < 200; ++i) {
        const glm::dvec2 place{std::fmod(0.618034 * i, 1), std::fmod(0.414214 * i, 1)};
        EXPECT_NEAR(ground.at(place * side_m, walk.drawn_stride()).height_m,
                    height_of_mesh(mesh, grid, p.real(models::kTerrainReliefM), place), 1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace psygen::world
