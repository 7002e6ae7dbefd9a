#include "ecs/commands.hpp"

#include <gtest/gtest.h>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(Commands, RecordStructuralChangesWhileIteratingAndApplyThemLater) {
  World world;
  const auto created = world.create<Health>(100);
  for (std::size_t i = 0; i < 100; ++i) {
    created.column<Health>()[i].points = static_cast<std::int32_t>(i % 4);
  }
  Commands commands;
  world.each<const Health>([&](std::span<const Entity> entities, std::span<const Health> health) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
      if (health[i].points == 0) commands.destroy(entities[i]);
      if (health[i].points == 1) commands.add<Hidden>(entities[i]);
      if (health[i].points == 2) commands.create(Position{1, 2, 3}, Mesh{9});
    }
  });
  EXPECT_EQ(world.size(), 100U);
  commands.apply(world);
  EXPECT_TRUE(commands.empty());
  EXPECT_EQ(world.count<Health>(), 75U);
  EXPECT_EQ(world.count<Hidden>(), 25U);
  EXPECT_EQ((world.count<Position, Mesh>()), 25U);
  world.each<const Position, const Mesh>([](auto, auto positions, auto meshes) {
    EXPECT_EQ(positions[24].z, 3.0F);
    EXPECT_EQ(meshes[24].id, 9U);
  });
}

TEST(Commands, AreAppliedInTheOrderOfRecording) {
  World world;
  const Entity entity = world.create<Position>(1).entities[0];
  Commands commands;
  commands.add(entity, Mesh{1});
  commands.remove<Mesh>(entity);
  commands.add(entity, Mesh{2});
  commands.add(entity, Mesh{3});
  commands.apply(world);
  EXPECT_EQ(world.get<Mesh>(entity)->id, 3U);
  commands.destroy(entity);
  commands.add(entity, Mesh{4});
  commands.apply(world);
  EXPECT_FALSE(world.alive(entity));
}

TEST(Commands, CarryMoveOnlyValues) {
  World world;
  Commands commands;
  commands.create(Owner{std::make_unique<int>(1)});
  commands.create(Owner{std::make_unique<int>(2)});
  Commands moved = std::move(commands);
  moved.apply(world);
  std::vector<int> values;
  world.each<const Owner>([&](auto, std::span<const Owner> owners) {
    for (const Owner& owner : owners)
      values.push_back(*owner.value);
  });
  EXPECT_EQ(values, (std::vector<int>{1, 2}));
}

TEST(Commands, AreDroppedWithoutApply) {
  {
    Commands commands;
    commands.create(Throwing{}, Owner{std::make_unique<int>(1)});
  }
  EXPECT_EQ(Throwing::alive, 0);
}

TEST(Commands, AfterAThrowingConstructorAreKept) {
  World world;
  const std::vector<Entity> entities = [&] {
    const auto created = world.create<Position>(2).entities;
    return std::vector<Entity>(created.begin(), created.end());
  }();
  Commands commands;
  commands.add<Throwing>(entities[0]);
  commands.destroy(entities[1]);
  Throwing::fuse = 0;
  EXPECT_THROW(commands.apply(world), std::runtime_error);
  Throwing::fuse = -1;
  EXPECT_FALSE(commands.empty());
  commands.apply(world);
  EXPECT_FALSE(world.alive(entities[1]));
}

}  // namespace
}  // namespace psygen::ecs
