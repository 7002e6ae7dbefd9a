// Children of a parent are one contiguous list; parents do not multiply archetypes.
#include <gtest/gtest.h>

#include <vector>

#include "tests/ecs/components.hpp"

namespace psygen::ecs::test {
namespace {

TEST(Children, AThousandParentsMakeTwoTables) {
  World world;
  const std::vector<Entity> parents = copy(world.create<Children, Position>(1000).entities);
  for (const Entity parent : parents)
    EXPECT_TRUE(world.set_children(parent, world.create<Mesh>(5).entities));
  EXPECT_EQ(world.table_count(), 2U);
  for (const Entity parent : parents) {
    ASSERT_EQ(world.children(parent).size(), 5U);
    for (const Entity child : world.children(parent))
      EXPECT_NE(world.get<Mesh>(child), nullptr);
  }
}

TEST(Children, ListKeepsItsOrderAndCanBeReplaced) {
  World world;
  const Entity parent = world.create<Children>(1).entities[0];
  const std::vector<Entity> c = copy(world.create<Mesh>(9).entities);
  world.set_children(parent, std::vector{c[3], c[1], c[2]});
  EXPECT_EQ(copy(world.children(parent)), (std::vector<Entity>{c[3], c[1], c[2]}));
  world.set_children(parent, c);
  EXPECT_EQ(copy(world.children(parent)), c);
  world.set_children(parent, world.children(parent).first(2));  // from the list itself
  EXPECT_EQ(copy(world.children(parent)), (std::vector<Entity>{c[0], c[1]}));
  world.set_children(parent, {});
  EXPECT_TRUE(world.children(parent).empty());
}

TEST(Children, EntitiesWithoutTheComponentHaveNoChildren) {
  World world;
  const Entity plain = world.create<Position>(1).entities[0];
  EXPECT_FALSE(world.set_children(plain, {}));
  EXPECT_FALSE(world.set_children(Entity{}, {}));
  EXPECT_TRUE(world.children(plain).empty());
  EXPECT_TRUE(world.children(Entity{}).empty());
}

TEST(Children, FamiliesDieTogether) {
  World world;
  const Entity root = world.create<Children>(1).entities[0];
  const std::vector<Entity> middle = copy(world.create<Children>(3).entities);
  world.set_children(root, middle);
  for (const Entity m : middle)
    world.set_children(m, world.create<Mesh>(4).entities);
  const Entity other = world.create<Mesh>(1).entities[0];
  EXPECT_EQ(world.destroy_with_children(std::vector{root}), 1U + 3U + 12U);
  EXPECT_EQ(world.size(), 1U);
  EXPECT_TRUE(world.alive(other));
}

TEST(Children, ACycleOfParentsDiesOnce) {
  World world;
  const std::vector<Entity> two = copy(world.create<Children>(2).entities);
  world.set_children(two[0], std::vector{two[1]});
  world.set_children(two[1], std::vector{two[0], two[1]});
  EXPECT_EQ(world.destroy_with_children(two), 2U);
}

TEST(Children, ListsOfDeadParentsAreReused) {
  World world;
  const std::vector<Entity> children = copy(world.create<Mesh>(60).entities);
  std::size_t bytes = 0;
  for (int round = 0; round < 100; ++round) {
    const std::vector<Entity> parents = copy(world.create<Children>(50).entities);
    for (const Entity parent : parents)
      world.set_children(parent, children);
    if (round % 2 == 0) world.remove<Children>(parents);
    world.destroy(parents);
    if (round == 1) bytes = world.committed_bytes();
  }
  EXPECT_EQ(world.committed_bytes(), bytes);
}

TEST(Children, AParentThatMovesKeepsItsList) {
  World world;
  const std::vector<Entity> parents = copy(world.create<Children>(3).entities);
  const std::vector<Entity> children = copy(world.create<Mesh>(2).entities);
  world.set_children(parents[2], children);
  world.add<Velocity>(parents);
  world.destroy(std::span(parents).first(1));
  EXPECT_EQ(copy(world.children(parents[2])), children);
}

TEST(Children, CommandsDestroyFamilies) {
  World world;
  const Entity root = world.create<Children>(1).entities[0];
  world.set_children(root, world.create<Mesh>(4).entities);
  Commands commands;
  world.each<const Mesh>([&](auto, auto) { commands.destroy_with_children(root); });
  commands.apply(world);
  EXPECT_EQ(world.size(), 0U);
}

TEST(Children, ListsThatShareChildrenDieInLinearTime) {
  World world;
  std::vector<Entity> chain = copy(world.create<Children>(200).entities);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    world.set_children(chain[i], std::vector{chain[i + 1], chain[i + 1]});
  EXPECT_EQ(world.destroy_with_children(std::vector{chain[0], chain[0]}), 200U);
}

TEST(Children, AListOfAnotherWorldIsEmptyHere) {
  World world;
  World other;
  const Entity parent = world.create<Children>(1).entities[0];
  world.set_children(parent, world.create<Mesh>(5).entities);
  EXPECT_TRUE(other.children(*world.get<Children>(parent)).empty());
  static_assert(!std::is_copy_constructible_v<Children> && !std::is_move_assignable_v<Children>);
}

TEST(Children, CommandsSetChildren) {
  World world;
  const Entity parent = world.create<Children>(1).entities[0];
  const std::vector<Entity> children = copy(world.create<Mesh>(3).entities);
  Commands commands;
  world.each<const Mesh>([&](auto entities, auto) { commands.set_children(parent, entities); });
  commands.apply(world);
  EXPECT_EQ(copy(world.children(parent)), children);
}

TEST(ChildrenDeathTest, SettingChildrenWhileIteratingEndsTheProgram) {
  World world;
  const Entity parent = world.create<Children>(1).entities[0];
  EXPECT_DEATH(world.each<const Children>([&](auto, auto) { world.set_children(parent, {}); }),
               "structural change .set_children. while iterating <const Children>");
}

}  // namespace
}  // namespace psygen::ecs::test
