#include <gtest/gtest.h>

#include <glm/vector_relational.hpp>
#include <vector>

#include "engine/scene/facts/derive.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

// The models of a few blocks.
std::vector<synthesis::CostSample> samples_of(const world::World& world,
                                              const models::Registry& registry) {
  std::vector<synthesis::CostSample> samples;
  for (int x = 0; x < 3; ++x) {
    std::vector<world::Placement> placed;
    world::place_models(world, registry, {x, 0}, placed);
    for (const world::Placement& placement : placed)
      samples.push_back({placement.model, placement.parameters});
  }
  return samples;
}

TEST(TypicalBounds, LieInsideTheConservativeBoundsAndAreMuchSmallerForTrees) {
  models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  const auto samples = samples_of(world, registry);
  const std::vector<core::Bounds> boxes = typical_bounds(registry, samples);
  ASSERT_EQ(boxes.size(), registry.size());
  for (const core::Bounds& box : boxes) {
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.min, glm::vec3(-1.0F))));
    EXPECT_TRUE(glm::all(glm::lessThanEqual(box.max, glm::vec3(1.0F))));
    EXPECT_TRUE(glm::all(glm::lessThanEqual(box.min, box.max)));
  }
  const glm::vec3 tree = boxes[world.scatter[0].model].half_extent();
  EXPECT_LT(tree.x * tree.y * tree.z, 0.5F);
  EXPECT_GT(tree.x * tree.y * tree.z, 0.02F);
}

TEST(TypicalBounds, AreTheWholeBoundsForTypesWithoutSamples) {
  const models::Registry registry = models::make_standard_registry();
  for (const core::Bounds& box : typical_bounds(registry, {})) {
    EXPECT_EQ(box.min, glm::vec3(-1.0F));
    EXPECT_EQ(box.max, glm::vec3(1.0F));
  }
}

}  // namespace
}  // namespace psygen::scene
