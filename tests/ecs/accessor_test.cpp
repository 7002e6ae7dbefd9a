#include "ecs/accessor.hpp"

#include <gtest/gtest.h>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(Accessor, follows_entities_through_every_structural_change) {
  World world;
  const Accessor<Position> positions = world.accessor<Position>();
  const auto created = world.create<Position>(3);
  const std::vector<Entity> entities(created.entities.begin(), created.entities.end());
  for (std::size_t i = 0; i < 3; ++i)
    positions.get(entities[i])->x = static_cast<float>(i);
  world.add<Velocity>(std::span(entities).last(1));
  world.destroy(std::span(entities).first(1));
  EXPECT_EQ(positions.get(entities[0]), nullptr);
  EXPECT_EQ(positions.get(entities[1])->x, 1.0F);
  EXPECT_EQ(positions.get(entities[2])->x, 2.0F);
  EXPECT_EQ(positions.get(entities[2]), world.get<Position>(entities[2]));
}

TEST(Accessor, gives_null_for_entities_without_the_component) {
  World world;
  const Entity entity = world.create<Velocity>(1).entities[0];
  const Accessor<const Position> positions = world.accessor<const Position>();
  EXPECT_EQ(positions.get(entity), nullptr);
  EXPECT_EQ(positions.get(kNullEntity), nullptr);
}

}  // namespace
}  // namespace psygen::ecs
