#include "engine/query/block_source.hpp"

#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::query {
namespace {

using testing::Loaded;

TEST(BlockSource, HeightsAreThoseOfTheFinestMesh) {
  for (const char* name : testing::kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    const core::BlockCoord block{(1 << 30) + 7, -3};
    const auto mesh = models::test::synthesize(loaded.registry[loaded.world.terrain_model],
                                               world::terrain_parameters(loaded.world, block), 0);
    const auto vertices = mesh.vertices<core::TerrainVertex>();
    const std::vector<std::uint16_t> heights = ground_of_block(loaded.world, block);
    ASSERT_EQ(heights.size(), 64U * 64U);
    for (std::size_t i = 0; i < heights.size(); ++i)
      ASSERT_EQ(heights[i], vertices[i].height) << name;
  }
}

TEST(BlockSource, ModelsAreThoseThatTheWorldPlaces) {
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

}  // namespace
}  // namespace psygen::query
