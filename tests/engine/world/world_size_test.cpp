#include <gtest/gtest.h>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::game_file;
using testing::kSmallWorld;
using testing::parsed;
using testing::registry;
using testing::replaced;

constexpr const char* kRocksOnly = R"(format = 1
[world]
name = "rocks"
seed = 3
blocks = [20, 30]
block_vertices = 17
[[scatter]]
model = "rock"
count = 7
subdivisions = 2
[[scatter]]
model = "rock"
count = 2
subdivisions = 0
)";

TEST(WorldSize, IsExactForTerrainAndRocks) {
  const WorldSize size = world_size(parsed(kRocksOnly), registry());
  EXPECT_FALSE(size.endless);
  EXPECT_EQ(size.blocks, 600U);
  EXPECT_EQ(size.models, 600U * 9);
  EXPECT_EQ(size.block_triangles, 2 * 16 * 16 + 7 * 64 + 2 * 4);
  EXPECT_EQ(size.triangles, 600 * (2 * 16 * 16 + 7 * 64 + 2 * 4));
  EXPECT_EQ(size.bytes_paper, size.triangles * 256);
}

TEST(WorldSize, OfThePapersWorldMatchesThePaper) {
  const World world = load_world(game_file("worlds/paper.toml"), registry()).value();
  const WorldSize size = world_size(world, registry());
  EXPECT_EQ(size.blocks, 262'144U);
  EXPECT_EQ(size.models, 262'144U * 63);
  EXPECT_NEAR(size.triangles, 32.8e9, 1.5e9);
  EXPECT_NEAR(size.bytes_paper, 8.4e12, 0.4e12);
  EXPECT_LT(size.bytes, size.bytes_paper / 5);
}

TEST(WorldSize, AgreesWithTheMeshesOfManyBlocks) {
  const World world = load_world(game_file("worlds/paper.toml"), registry()).value();
  const WorldSize size = world_size(world, registry());
  std::vector<Placement> placements;
  double triangles = 0;
  constexpr int kManyBlocks = 60;
  for (std::int32_t i = 0; i < kManyBlocks; ++i) {
    triangles += models::terrain_surface_triangles(world.terrain, 0);
    place_models(world, registry(), {100 + i, 300}, placements);
    for (const Placement& p : placements)
      triangles += registry()[p.model].mesh_size(p.parameters, 0).triangle_count();
  }
  EXPECT_NEAR(triangles / kManyBlocks, size.block_triangles, size.block_triangles * 0.08);
}

TEST(WorldSize, AnEndlessWorldHasTheSizeOfABlockOnly) {
  const WorldSize size = world_size(parsed(replaced(kRocksOnly, "[20, 30]", "[0, 0]")), registry());
  EXPECT_TRUE(size.endless);
  EXPECT_EQ(size.blocks, 0U);
  EXPECT_EQ(size.models, 0U);
  EXPECT_EQ(size.triangles, 0);
  EXPECT_EQ(size.block_models, 9);
}

TEST(WorldSize, ModelsThatFindNoPlaceAreNotCounted) {
  const World none = parsed(replaced(kRocksOnly, "count = 7", "count = 7\nmin_height_m = 9999"));
  EXPECT_EQ(world_size(none, registry()).block_models, 2);
  EXPECT_EQ(world_size(none, registry()).block_triangles, 2 * 16 * 16 + 2 * 4);
}

TEST(WorldSize, OfTheLargestFiniteWorldDoesNotOverflow) {
  const WorldSize size =
      world_size(parsed(replaced(kRocksOnly, "[20, 30]", "[2147483648, 2147483648]")), registry());
  EXPECT_EQ(size.blocks, std::uint64_t{1} << 62);
  EXPECT_EQ(size.models, UINT64_MAX);
}

}  // namespace
}  // namespace psygen::world
