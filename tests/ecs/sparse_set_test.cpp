// Sparse components: stored apart, so adding and removing them moves nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/ecs/components.hpp"

namespace psygen::ecs::test {
namespace {

TEST(SparseSet, TogglingMovesNoRowAndMakesNoTable) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(100).entities);
  const Position* before = world.get<Position>(all[50]);
  const std::size_t tables = world.table_count();
  EXPECT_EQ(world.add<Selected>(all), 100U);
  EXPECT_EQ(world.get<Position>(all[50]), before);
  EXPECT_EQ(world.table_count(), tables);
  EXPECT_EQ(world.count<Selected>(), 100U);
  EXPECT_EQ(world.remove<Selected>(std::span(all).first(40)), 40U);
  EXPECT_EQ(world.count<Selected>(), 60U);
  EXPECT_EQ(world.get<Selected>(all[39]), nullptr);
  EXPECT_NE(world.get<Selected>(all[40]), nullptr);
}

TEST(SparseSet, SkipsMembersDeadEntitiesAndRepetitions) {
  World world;
  std::vector<Entity> all = copy(world.create<Position>(4).entities);
  world.destroy(std::span(all).first(1));
  all.push_back(all[1]);
  EXPECT_EQ(world.add<Edited>(all), 3U);
  EXPECT_EQ(world.add<Edited>(all), 0U);
  EXPECT_EQ(world.remove<Edited>(all), 3U);
  EXPECT_EQ(world.remove<Edited>(all), 0U);
}

TEST(SparseSet, ANewValueIsValueInitialisedAndThenKept) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(3).entities);
  world.add<Edited>(all);
  EXPECT_EQ(world.get<Edited>(all[2])->version, 1U);
  world.get<Edited>(all[2])->version = 7;
  world.remove<Edited>(std::span(all).first(2));
  EXPECT_EQ(world.get<Edited>(all[2])->version, 7U);
}

TEST(SparseSet, DeadEntitiesLeaveAndTheirIndexIsFree) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(3).entities);
  world.add<Edited>(all);
  auto reader = world.reader<Edited>(Removed::kReport);
  world.destroy(std::span(all).first(2));
  EXPECT_EQ(world.count<Edited>(), 1U);
  std::vector<Entity> gone;
  reader.drain_removed([&](auto entities) { gone = copy(entities); });
  EXPECT_EQ(gone, (std::vector<Entity>{all[0], all[1]}));
  for (const Entity heir : copy(world.create<Position>(2).entities))
    EXPECT_EQ(world.get<Edited>(heir), nullptr);
  EXPECT_EQ(world.get<Edited>(all[0]), nullptr);
}

TEST(SparseSet, TracksChangesLikeColumns) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(1000).entities);
  world.add<Edited>(all);
  auto reader = world.reader<Edited>();
  EXPECT_EQ(reader.drain([](auto, auto) {}), 1000U);
  world.mark_changed<Edited>(std::vector{all[3], all[700]});
  const std::vector<Landing<Edited>> results{{all[5], {9}}, {Entity{}, {9}}};
  EXPECT_EQ(world.land<Edited>(results), (WriteReport{1, 1}));
  world.remove<Edited>(std::span(all).first(4));  // moves rows, one of them marked
  std::vector<Entity> seen;
  reader.drain([&](std::span<const Entity> entities, std::span<const Edited>) {
    seen.insert(seen.end(), entities.begin(), entities.end());
  });
  std::ranges::sort(seen, {}, &Entity::index);
  EXPECT_EQ(seen, (std::vector<Entity>{all[5], all[700]}));
}

TEST(SparseSet, IsIteratedByItself) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(10).entities);
  world.each<Edited>([](auto, auto) { FAIL() << "no entity has it"; });
  world.add<Edited>(std::span(all).subspan(4));
  std::size_t calls = 0;
  world.each<Edited>([&](std::span<const Entity> entities, std::span<Edited> edited) {
    ++calls;
    EXPECT_EQ(entities.size(), 6U);
    for (Edited& e : edited)
      e.version = 2;
  });
  EXPECT_EQ(calls, 1U);
  EXPECT_EQ(world.get<Edited>(all[9])->version, 2U);
}

struct Filters : testing::Test {
  World world;
  std::vector<Entity> plain = copy(world.create<Position>(20).entities);
  std::vector<Entity> moving = copy(world.create<Position, Velocity>(20).entities);

  template <class... Fs>
  std::vector<Entity> found(Fs... filters) {
    std::vector<Entity> result;
    world.each<const Position>(
        [&](std::span<const Entity> entities, std::span<const Position> rows) {
          EXPECT_EQ(entities.size(), rows.size());
          for (std::size_t i = 0; i < rows.size(); ++i)
            EXPECT_EQ(&rows[i], world.get<Position>(entities[i]));
          result.insert(result.end(), entities.begin(), entities.end());
        },
        filters...);
    std::ranges::sort(result, {}, &Entity::index);
    return result;
  }
};

TEST_F(Filters, WithVisitsMembersOnly) {
  const std::vector<Entity> some{plain[3], plain[4], moving[0]};
  EXPECT_TRUE(found(With<Selected>{}).empty());
  world.add<Selected>(some);
  EXPECT_EQ(found(With<Selected>{}), some);
  EXPECT_EQ(found(With<Selected, Velocity>{}), std::vector<Entity>{moving[0]});
  EXPECT_EQ(found(With<Selected>{}, Without<Velocity>{}),
            (std::vector<Entity>{plain[3], plain[4]}));
  world.add<Edited>(std::vector{plain[4]});
  EXPECT_EQ(found(With<Selected, Edited>{}), std::vector<Entity>{plain[4]});
}

TEST_F(Filters, WithoutCutsTablesIntoRuns) {
  EXPECT_EQ(found(Without<Selected>{}).size(), 40U);
  world.add<Selected>(std::vector{plain[0], plain[7], plain[8], moving[19]});
  std::vector<Entity> expected;
  for (const Entity e : plain) {
    if (e != plain[0] && e != plain[7] && e != plain[8]) expected.push_back(e);
  }
  expected.insert(expected.end(), moving.begin(), moving.end() - 1);
  EXPECT_EQ(found(Without<Selected>{}), expected);
  world.add<Edited>(std::vector{plain[0], plain[1]});
  EXPECT_EQ(found(With<Edited>{}, Without<Selected>{}), std::vector<Entity>{plain[1]});
}

TEST_F(Filters, RunsMarkTheirOwnRows) {
  const std::vector<Entity> meshes = copy(world.create<Mesh>(100).entities);
  auto reader = world.reader<Mesh>();
  reader.drain([](auto, auto) {});
  world.add<Selected>(std::vector{meshes[40], meshes[41]});
  world.each<Mesh>([](TableRows<Mesh> rows, std::span<const Entity>,
                      std::span<Mesh>) { rows.mark_changed<Mesh>(1, 1); },
                   With<Selected>{});
  std::vector<Entity> seen;
  reader.drain([&](std::span<const Entity> entities, std::span<const Mesh>) {
    seen.insert(seen.end(), entities.begin(), entities.end());
  });
  EXPECT_EQ(seen, std::vector<Entity>{meshes[41]});
}

TEST(SparseSet, AThrowingConstructorLeavesTheSetUnchanged) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(8).entities);
  Throwing::fuse = 3;
  EXPECT_THROW(world.add<Fused>(all), std::runtime_error);
  Throwing::fuse = -1;
  EXPECT_EQ(world.count<Fused>(), 0U);
  EXPECT_EQ(world.get<Fused>(all[0]), nullptr);
  EXPECT_EQ(world.add<Fused>(all), 8U);
}

TEST(SparseSetDeathTest, TogglingWhileIteratingViolatesTheContract) {
  World world;
  const std::vector<Entity> all = copy(world.create<Position>(1).entities);
  world.declare<Selected>();
  EXPECT_DEATH(world.each<const Position>([&](auto, auto) { world.add<Selected>(all); }),
               "structural change .add. while iterating <const .*Position>");
}

TEST(SparseSet, AddingMembersAgainNeedsNoRoom) {
  World world(WorldLimits{.max_rows_per_table = 100});
  const std::vector<Entity> all = copy(world.create<Position>(60).entities);
  EXPECT_EQ(world.add<Selected>(all), 60U);
  EXPECT_EQ(world.add<Selected>(all), 0U);
}

}  // namespace
}  // namespace psygen::ecs::test
