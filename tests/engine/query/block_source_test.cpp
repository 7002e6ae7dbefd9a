#include "engine/query/block_cache.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/query/worlds.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::query {
namespace {

using testing::Loaded;

TEST(BlockSource, HeightsAreThoseOfTheFinestMesh) {
  for (const char* name : testing::kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    const core::BlockCoord block{(1 << 30) + 7, -3};
    const auto mesh = models::test::synthesise(loaded.registry[loaded.world.terrain_model],
                                               world::terrain_parameters(loaded.world, block), 0);
    const auto vertices = mesh.vertices<core::TerrainVertex>();
    const std::vector<std::uint16_t> heights = ground_of_block(loaded.world, block);
    ASSERT_EQ(heights.size(), 64U * 64U);
    for (std::size_t i = 0; i < heights.size(); ++i)
      ASSERT_EQ(heights[i], vertices[i].height) << name;
  }
}

TEST(BlockSource, ModelsAreThoseOfTheWorld) {
  const Loaded loaded = Loaded::shipped("silver_combe");
  std::vector<world::Placement> placed;
  world::place_models(loaded.world, loaded.registry, {5, 6}, placed);
  const auto models = models_of_block(loaded.world, loaded.registry, {5, 6});
  ASSERT_EQ(models.size(), placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    EXPECT_EQ(models[i].index, placed[i].index);
    EXPECT_EQ(models[i].position, placed[i].position);
  }
}

TEST(BlockSource, StampsAndRoadsShapeTheGroundAndAreNoEdits) {
  world::World world = world::testing::shaped_world(world::testing::kShapes);
  const models::Registry& registry = world::testing::registry();
  const core::BlockCoord block{2, 2};
  const auto mesh = models::test::synthesise(registry[world.terrain_model],
                                             world::terrain_parameters(world, block), 0);
  const auto vertices = mesh.vertices<core::TerrainVertex>();
  const std::vector<std::uint16_t> heights = ground_of_block(world, block);
  const auto plain = ground_of_block(world::testing::parsed(world::testing::kSmallWorld), block);
  for (std::size_t i = 0; i < heights.size(); ++i)
    ASSERT_EQ(heights[i], vertices[i].height);
  EXPECT_NE(heights, plain);
  EXPECT_EQ(edits_of_block(world, block), 0U);
  world::Edits edits;
  ASSERT_TRUE(edits.raise(world, {{7, 3}, {30, 0, 30}}, 5, 2));
  world::set_edits(world, edits.layer());
  EXPECT_EQ(edits_of_block(world, block), 0U);
  EXPECT_NE(edits_of_block(world, {7, 3}), 0U);
  EXPECT_EQ(ground_of_block(world, block), heights);
  // A road has its own surface kind.
  World query(world, registry);
  const auto on_it = query.ground({{0, 0}, {140, 0, 140}});
  ASSERT_TRUE(on_it);
  EXPECT_EQ(on_it->kind, world::GroundKind::kRock);
}

TEST(BlockSource, EditsOfABlockChangeItsHashAndItsContent) {
  Loaded loaded = Loaded::shipped("silver_combe");
  const core::BlockCoord block{5, 6}, far{50, 60};
  const std::vector<std::uint16_t> ground = ground_of_block(loaded.world, block);
  const auto models = models_of_block(loaded.world, loaded.registry, block);
  ASSERT_FALSE(models.empty());
  EXPECT_EQ(edits_of_block(loaded.world, block), 0U);

  world::Edits edits;
  ASSERT_TRUE(edits.remove(loaded.world, {block, models[0].index}));
  world::set_edits(loaded.world, edits.layer());
  const std::uint64_t felled = edits_of_block(loaded.world, block);
  EXPECT_NE(felled, 0U);
  const auto left = models_of_block(loaded.world, loaded.registry, block);
  ASSERT_EQ(left.size(), models.size() - 1);
  EXPECT_EQ(left[0].index, models[1].index);
  EXPECT_EQ(ground_of_block(loaded.world, block), ground);

  ASSERT_TRUE(edits.raise(loaded.world, {block, {30, 0, 30}}, 10, 2));
  world::set_edits(loaded.world, edits.layer());
  EXPECT_NE(edits_of_block(loaded.world, block), felled);
  EXPECT_NE(ground_of_block(loaded.world, block), ground);
  EXPECT_EQ(edits_of_block(loaded.world, far), 0U);

  world::set_edits(loaded.world, nullptr);
  EXPECT_EQ(edits_of_block(loaded.world, block), 0U);
  EXPECT_EQ(ground_of_block(loaded.world, block), ground);
}

}  // namespace
}  // namespace psygen::query
