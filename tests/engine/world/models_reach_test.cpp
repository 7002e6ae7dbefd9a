
#include <gtest/gtest.h>

#include "engine/world/placement.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

TEST(ModelsReach, HoldsTheBoxesOfAllModels) {
  for (const char* name :
       {"paper", "silver_combe", "five_species", "ember_pass", "thorn_country", "frost_isle"}) {
    models::Registry models = models::make_standard_registry();
    const auto world =
        load_world(testing::game_file("worlds/" + std::string(name) + ".toml"), models);
    ASSERT_TRUE(world) << world.error().message;
    const glm::vec2 reach = models_reach_m(*world, models);
    std::vector<Placement> placed;
    float widest = 0;
    for (std::int32_t i = 0; i < 20; ++i) {
      place_models(*world, models, {100 + i, 50}, placed);
      for (const Placement& p : placed) {
        const core::Bounds box = models[p.model].bounds(p.parameters);
        widest = std::max({widest, -box.min.x, -box.min.z, box.max.x, box.max.z});
        ASSERT_LE(box.max.y, reach.y);
      }
    }
    EXPECT_LE(widest, reach.x);
    EXPECT_GT(widest, 0.3F * reach.x);
  }
}

TEST(ModelsReach, IsNothingWithoutModels) {
  World world = testing::parsed(testing::kSmallWorld);
  world.scatter.clear();
  EXPECT_EQ(models_reach_m(world, testing::registry()), glm::vec2(0));
}

}  // namespace
}  // namespace psygen::world
