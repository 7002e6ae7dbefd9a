#include "editor/pictures/model_world.hpp"

#include <gtest/gtest.h>

#include "engine/world/placement.hpp"
#include "tests/editor/pictures/worlds.hpp"

namespace psygen::editor {
namespace {

TEST(ModelWorld, EveryModelOfTheShippedWorldsCanBePortrayed) {
  for (const std::string& name : testing::shipped_worlds()) {
    const std::string text = testing::world_text(name);
    const auto parsed = parse_world_text(text, name, {});
    ASSERT_TRUE(parsed.has_value());
    for (std::size_t i = 0; i < (*parsed)->world.scatter.size(); ++i) {
      SCOPED_TRACE(name + " scatter " + std::to_string(i));
      const auto portrait = portrait_of(text, {"scatter", i});
      ASSERT_TRUE(portrait.has_value()) << portrait.error().message;
      const auto alone = parse_world_text(*portrait, name, {});
      ASSERT_TRUE(alone.has_value()) << alone.error().message << *portrait;
      ASSERT_EQ((*alone)->world.scatter.size(), 1U);
      EXPECT_EQ((*alone)->world.scatter[0].count, 1U);
      EXPECT_EQ((*alone)->registry[(*alone)->world.scatter[0].model].name(),
                (*parsed)->registry[(*parsed)->world.scatter[i].model].name());
      EXPECT_EQ((*alone)->world.scatter[0].ranges, (*parsed)->world.scatter[i].ranges);
    }
    for (std::size_t i = 0; i < (*parsed)->world.species.size(); ++i) {
      const auto portrait = portrait_of(text, {"species", i});
      ASSERT_TRUE(portrait.has_value()) << portrait.error().message;
      EXPECT_TRUE(parse_world_text(*portrait, name, {}).has_value());
    }
  }
}

TEST(ModelWorld, TheImageShowsTheWholeModel) {
  const std::string text = testing::world_text("silver_combe");
  for (std::size_t i = 0; i < 4; ++i) {
    const auto parsed = parse_world_text(*portrait_of(text, {"scatter", i}), "", {});
    ASSERT_TRUE(parsed.has_value());
    const core::Projection projection{0.9F, 1.4F, 0.2F};
    const auto pose = portrait_pose(**parsed, projection);
    ASSERT_TRUE(pose.has_value());
    std::vector<world::Placement> placements;
    world::place_models((*parsed)->world, (*parsed)->registry, pose->pose.position.block,
                        placements);
    ASSERT_EQ(placements.size(), 1U);
    const double away_m =
        glm::length(glm::dvec3(placements[0].position) - pose->pose.position.local);
    EXPECT_GT(away_m, 1);
    EXPECT_LT(away_m, 80);
  }
}

TEST(ModelWorld, MissingScattersAndSpeciesAreErrors) {
  EXPECT_FALSE(portrait_of(testing::world_text("silver_combe"), {"scatter", 99}).has_value());
  EXPECT_FALSE(portrait_of(testing::world_text("endless"), {"species", 0}).has_value());
  EXPECT_FALSE(snippet_world("[palette]\ngrass = [0, 0, 0]\n").has_value());
  EXPECT_FALSE(snippet_world("not toml [").has_value());
}

}  // namespace
}  // namespace psygen::editor
