#include "ecs/accessor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(Accessor, FollowsEntitiesThroughEveryStructuralChange) {
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

TEST(Accessor, ReturnsNullForEntitiesWithoutTheComponent) {
  World world;
  const Entity entity = world.create<Velocity>(1).entities[0];
  const Accessor<const Position> positions = world.accessor<const Position>();
  EXPECT_EQ(positions.get(entity), nullptr);
  EXPECT_EQ(positions.get(kNullEntity), nullptr);
}

TEST(Accessor, EachVisitsHandlesInOrderWithNullForDeadEntities) {
  World world;
  const auto created = world.create<Mesh>(100).entities;
  std::vector<Entity> entities(created.begin(), created.end());
  for (std::size_t i = 0; i < entities.size(); ++i)
    world.get<Mesh>(entities[i])->id = i;
  std::ranges::reverse(entities);
  world.destroy(std::span(entities).subspan(30, 5));
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 100U}) {
    std::size_t next = 0;
    world.accessor<const Mesh>().each(std::span(entities).first(count),
                                      [&](std::size_t i, const Mesh* mesh) {
                                        EXPECT_EQ(i, next++);
                                        EXPECT_EQ(mesh == nullptr, i >= 30 && i < 35);
                                        if (mesh != nullptr) {
                                          EXPECT_EQ(mesh->id, 99 - i);
                                        }
                                      });
    EXPECT_EQ(next, count);
  }
}

TEST(Accessor, AConstWorldMakesReadOnlyAccessorsEvenForUnknownComponents) {
  World world;
  const Entity entity = world.create<Position>(1).entities[0];
  const World& read_only = world;
  EXPECT_NE(read_only.accessor<const Position>().get(entity), nullptr);
  EXPECT_EQ(read_only.accessor<const Mesh>().get(entity), nullptr);
  EXPECT_EQ(read_only.accessor<const Selected>().get(entity), nullptr);
  EXPECT_EQ(read_only.get<Edited>(entity), nullptr);
}

}  // namespace
}  // namespace psygen::ecs
