#include "ecs/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(World, CreatedColumnsAreContiguousAlignedAndValueInitialised) {
  World world;
  for (int round = 0; round < 3; ++round) {
    const auto created = world.create<Position, Health, Aligned>(1000);
    ASSERT_EQ(created.entities.size(), 1000U);
    EXPECT_EQ(created.column<Position>().size(), 1000U);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(created.column<Aligned>().data()) % 64, 0U);
    for (std::size_t i = 0; i < 1000; ++i) {
      ASSERT_EQ(created.column<Position>()[i].x, 0.0F);
      ASSERT_EQ(created.column<Health>()[i].points, 100);
      ASSERT_EQ(world.get<Health>(created.entities[i]), &created.column<Health>()[i]);
    }
    std::ranges::fill(created.column<Position>(), Position{1, 2, 3});
    std::ranges::fill(created.column<Health>(), Health{1});
    world.destroy(copy(created.entities.subspan(100)));
  }
  EXPECT_EQ(world.size(), 300U);
}

TEST(World, CreatingNoEntitiesReturnsEmptySpans) {
  World world;
  const auto created = world.create<Position>(0);
  EXPECT_TRUE(created.entities.empty());
  EXPECT_TRUE(created.column<Position>().empty());
  EXPECT_EQ(world.size(), 0U);
}

TEST(World, TheOrderOfComponentTypesMakesNoOtherArchetype) {
  World world;
  world.create<Position, Velocity>(1);
  world.create<Velocity, Position>(1);
  EXPECT_EQ(world.table_count(), 1U);
}

TEST(World, AThousandParentsDoNotMakeAThousandTables) {
  World world;
  std::vector<std::vector<Entity>> children;
  for (int parent = 0; parent < 1000; ++parent) {
    children.push_back(copy(world.create<Position, Mesh>(10).entities));
  }
  EXPECT_EQ(world.table_count(), 1U);
  EXPECT_EQ(world.destroy(children[500]), 10U);
  EXPECT_EQ(world.size(), 9990U);
}

TEST(World, StaleHandlesAreRecognisedAfterTheirSlotIsReused) {
  World world;
  const Entity old = world.create<Position>(1).entities[0];
  EXPECT_EQ(world.destroy({&old, 1}), 1U);
  const Entity young = world.create<Position>(1).entities[0];
  EXPECT_EQ(young.index, old.index);
  EXPECT_FALSE(world.alive(old));
  EXPECT_TRUE(world.alive(young));
  EXPECT_EQ(world.get<Position>(old), nullptr);
  EXPECT_EQ(world.destroy({&old, 1}), 0U);
  EXPECT_FALSE(world.alive(kNullEntity));
}

TEST(World, AForgedHandleToAFreeSlotIsNotAlive) {
  World world;
  const Entity entity = world.create<Position>(1).entities[0];
  world.destroy({&entity, 1});
  const Entity forged{entity.index, entity.generation + 1};
  EXPECT_FALSE(world.alive(forged));
  EXPECT_EQ(world.get<Position>(forged), nullptr);
  EXPECT_EQ(world.destroy({&forged, 1}), 0U);
}

TEST(World, ARepeatedHandleDiesOnce) {
  World world;
  const Entity a = world.create<Position>(2).entities[0];
  const std::vector<Entity> twice{a, a};
  EXPECT_EQ(world.destroy(twice), 1U);
  EXPECT_EQ(world.size(), 1U);
}

TEST(World, HandlesStayDistinctWhenGenerationsRunOut) {
  World world({.first_generation = UINT32_MAX - 2});
  std::vector<Entity> seen;
  for (int round = 0; round < 10; ++round) {
    const Entity entity = world.create<Position>(1).entities[0];
    EXPECT_THAT(seen, testing::Not(testing::Contains(entity)));
    seen.push_back(entity);
    world.destroy({&entity, 1});
  }
  EXPECT_EQ(world.retired_slots(), 3U);
  for (const Entity entity : seen)
    EXPECT_FALSE(world.alive(entity));
}

TEST(World, WritingValuesHappensInPlaceAndDropsStaleHandles) {
  World world;
  const auto entities = copy(world.create<Mesh>(4).entities);
  const Entity meshless = world.create<Position>(1).entities[0];
  world.destroy(std::span(entities).first(1));
  const std::vector<Landing<Mesh>> results{{entities[0], {10}}, {entities[1], {11}},
                                           {meshless, {12}},    {kNullEntity, {13}},
                                           {entities[3], {14}}, {entities[3], {15}}};
  EXPECT_EQ(world.land<Mesh>(results), (WriteReport{3, 3}));
  EXPECT_EQ(world.get<Mesh>(entities[1])->id, 11U);
  EXPECT_EQ(world.get<Mesh>(entities[2])->id, 0U);
  EXPECT_EQ(world.get<Mesh>(entities[3])->id, 15U);
}

TEST(World, WritingValuesOfAnAbsentComponentDropsAll) {
  World world;
  const Entity entity = world.create<Position>(1).entities[0];
  const std::vector<Landing<Mesh>> results{{entity, {1}}};
  EXPECT_EQ(world.land<Mesh>(results), (WriteReport{0, 1}));
}

TEST(World, MoveOnlyComponentsAreWrittenAndSurviveEveryVerb) {
  World world;
  const auto entities = copy(world.create<Owner, Position>(100).entities);
  std::vector<Landing<Owner>> results;
  for (int i = 0; i < 100; ++i) {
    results.push_back({entities[static_cast<std::size_t>(i)], {std::make_unique<int>(i)}});
  }
  EXPECT_EQ(world.move_values<Owner>(results), (WriteReport{100, 0}));
  EXPECT_EQ(world.destroy(std::span(entities).first(30)), 30U);
  EXPECT_EQ(world.add<Velocity>(std::span(entities).subspan(20, 30)), 20U);
  for (std::size_t i = 30; i < 100; ++i) {
    EXPECT_EQ(*world.get<Owner>(entities[i])->value, static_cast<int>(i));
  }
  EXPECT_EQ(world.remove<Owner>(std::span(entities).last(10)), 10U);
  EXPECT_EQ(world.get<Owner>(entities[99]), nullptr);
}

TEST(World, AThrowingConstructorLeavesNoEntityAndNoObjectBehind) {
  {
    World world;
    world.create<Throwing, Owner>(5);
    Throwing::fuse = 3;
    EXPECT_THROW((world.create<Throwing, Owner>(10)), std::runtime_error);
    Throwing::fuse = -1;
    EXPECT_EQ(world.size(), 5U);
    EXPECT_EQ(Throwing::alive, 5);
    EXPECT_EQ(world.create<Throwing>(2).column<Throwing>()[1].value, 7);
  }
  EXPECT_EQ(Throwing::alive, 0);
}

TEST(World, AThrowingConstructorWhileAddingLeavesTheEntitiesAsTheyWere) {
  {
    World world;
    const auto entities = copy(world.create<Position>(5).entities);
    Throwing::fuse = 2;
    EXPECT_THROW(world.add<Throwing>(entities), std::runtime_error);
    Throwing::fuse = -1;
    EXPECT_EQ(Throwing::alive, 0);
    for (const Entity entity : entities) {
      EXPECT_NE(world.get<Position>(entity), nullptr);
      EXPECT_EQ(world.get<Throwing>(entity), nullptr);
    }
    EXPECT_EQ(world.add<Throwing>(entities), 5U);
    EXPECT_EQ(world.destroy(std::span(entities).first(2)), 2U);
    EXPECT_EQ(Throwing::alive, 3);
  }
  EXPECT_EQ(Throwing::alive, 0);
}

TEST(World, AddingAndRemovingKeepsTheOtherValues) {
  World world;
  const auto created = world.create<Position>(10);
  const auto entities = copy(created.entities);
  for (std::size_t i = 0; i < 10; ++i)
    created.column<Position>()[i].x = static_cast<float>(i);
  const std::vector<Entity> some{entities[2], entities[7], entities[2], kNullEntity};
  EXPECT_EQ((world.add<Velocity, Health>(some)), 2U);
  EXPECT_EQ((world.add<Velocity, Health>(some)), 0U);
  EXPECT_EQ(world.get<Health>(entities[7])->points, 100);
  EXPECT_EQ(world.count<Velocity>(), 2U);
  EXPECT_EQ(world.remove<Velocity>(entities), 2U);
  EXPECT_EQ(world.count<Velocity>(), 0U);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(world.get<Position>(entities[i])->x, static_cast<float>(i));
  }
}

TEST(World, ColumnsKeepTheirAddressWhileAnArchetypeGrows) {
  World world;
  const auto first = world.create<Position>(1);
  const Position* address = first.column<Position>().data();
  const Entity entity = first.entities[0];
  for (int i = 0; i < 100; ++i)
    world.create<Position>(1000);
  EXPECT_EQ(world.get<Position>(entity), address);
}

TEST(World, ReservingCommitsMemoryAhead) {
  World world;
  world.reserve<Position>(100000);
  const std::size_t bytes = world.committed_bytes();
  EXPECT_GE(bytes, 100000 * (sizeof(Position) + sizeof(Entity)));
  const auto created = world.create<Position>(100000);
  EXPECT_EQ(world.get<Position>(created.entities[99999]), &created.column<Position>()[99999]);
}

TEST(WorldDeathTest, AStructuralChangeWhileIteratingNamesTheQuery) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  World world;
  world.create<Mesh, Health>(1);
  const auto misuse = [&] {
    world.each<const Mesh, Health>([&](auto, auto, auto) { world.create<Position>(1); });
  };
  EXPECT_DEATH(misuse(), "structural change .create. while iterating <const mesh, .*Health>");
}

TEST(WorldDeathTest, AFullWorldEndsWithAMessage) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  World world({.max_entities = 10});
  EXPECT_DEATH(world.create<Position>(11), "max_entities");
}

TEST(World, ChangingTheArchetypeAddsAndRemovesInOneMove) {
  World world;
  const auto created = world.create<Mesh, Position>(5);
  created.column<Mesh>()[3].id = 7;
  const std::vector<Entity> all(created.entities.begin(), created.entities.end());
  EXPECT_EQ(world.change_archetype(std::span(all).subspan(2), Add<Velocity, Health>{},
                                   Remove<Position>{}),
            3U);
  EXPECT_EQ(world.get<Mesh>(all[3])->id, 7U);
  EXPECT_EQ(world.get<Health>(all[3])->points, 100);
  EXPECT_EQ(world.get<Position>(all[3]), nullptr);
  EXPECT_EQ(world.table_count(), 2U);  // no archetype in between
}

struct Large {
  std::array<std::uint8_t, std::size_t{16} << 20> bytes{};
};

TEST(World, AComponentLargerThanTheStackIsCreated) {
  World world;
  const Entity e = world.create<Large>(1).entities[0];
  EXPECT_EQ(world.get<Large>(e)->bytes.back(), 0);
}

template <std::size_t>
struct Numbered {
  std::uint8_t value = 3;
};
constexpr std::size_t kRun = 16;
template <std::size_t First, std::size_t... I>
void add_run(World& world, Entity e, std::index_sequence<I...>) {
  world.add<Numbered<First + I>...>({&e, 1});
}
template <std::size_t... Runs>
void add_runs(World& world, Entity e, std::index_sequence<Runs...>) {
  (add_run<Runs * kRun>(world, e, std::make_index_sequence<kRun>{}), ...);
}

TEST(World, AnArchetypeMayHaveAll256ComponentTypes) {
  World world;
  const Entity e = world.create<>(1).entities[0];
  add_runs(world, e, std::make_index_sequence<256 / kRun>{});
  EXPECT_EQ(world.get<Numbered<0>>(e)->value, 3);
  EXPECT_EQ(world.get<Numbered<255>>(e)->value, 3);
}

TEST(World, HugeLimitsAreAccepted) {
  World world(WorldLimits{.max_entities = SIZE_MAX, .max_rows_per_table = SIZE_MAX});
  EXPECT_EQ(world.create<Position>(1000).entities.size(), 1000U);
}

TEST(WorldDeathTest, ACountBeyondTheLimitsEndsWithAMessage) {
  World world;
  world.create<Position>(10);
  EXPECT_DEATH(world.create<Position>(SIZE_MAX), "max_rows_per_table");
  EXPECT_DEATH(world.reserve<Position>(SIZE_MAX - 5), "max_rows_per_table");
}

TEST(WorldDeathTest, ReservingWhileIteratingEndsTheProgram) {
  World world;
  world.create<Position>(1);
  EXPECT_DEATH(world.each<const Position>([&](auto, auto) { world.reserve<Mesh>(1); }),
               "structural change .reserve. while iterating <const .*Position>");
}

TEST(WorldDeathTest, StructuralChangesWhileFollowingHandlesEndTheProgram) {
  World world;
  const auto created = world.create<Position>(3).entities;
  const std::vector<Entity> all(created.begin(), created.end());
  EXPECT_DEATH(
      world.accessor<Position>().each(all, [&](std::size_t, Position*) { world.destroy(all); }),
      "structural change .destroy. while iterating <.*Position>");
}

TEST(WorldDeathTest, TwoTypesWithOneNameAreRejected) {
  World world;
  world.declare<Twin>();
  EXPECT_DEATH(world.declare<OtherTwin>(), "two component types are named 'twin'");
}

}  // namespace
}  // namespace psygen::ecs
