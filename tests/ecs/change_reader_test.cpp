#include "ecs/change_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

std::vector<Entity> drained(ChangeReader<Mesh>& reader) {
  std::vector<Entity> all;
  reader.drain([&](std::span<const Entity> entities, std::span<const Mesh> meshes) {
    EXPECT_EQ(entities.size(), meshes.size());
    all.insert(all.end(), entities.begin(), entities.end());
  });
  return all;
}

TEST(ChangeReader, ANewReaderSeesEveryRowAndThenNothing) {
  World world;
  const auto entities = copy(world.create<Mesh>(5).entities);
  auto reader = world.reader<Mesh>();
  EXPECT_EQ(drained(reader), entities);
  EXPECT_TRUE(drained(reader).empty());
}

TEST(ChangeReader, CreatingAddingWritingAndMarkingAreChanges) {
  World world;
  auto reader = world.reader<Mesh>();
  const auto with = copy(world.create<Mesh>(3).entities);
  EXPECT_EQ(drained(reader), with);
  const auto without = copy(world.create<Position>(2).entities);
  world.add<Mesh>(std::span(without).first(1));
  EXPECT_EQ(drained(reader), std::vector<Entity>{without[0]});
  const std::vector<Landing<Mesh>> results{{with[1], {1}}, {without[1], {2}}};
  world.land<Mesh>(results);
  EXPECT_EQ(drained(reader), std::vector<Entity>{with[1]});
  world.mark_changed<Mesh>(with[2]);
  EXPECT_EQ(drained(reader), std::vector<Entity>{with[2]});
}

TEST(ChangeReader, TenThousandScatteredChangesVisitTenThousandRows) {
  World world;
  const auto entities = copy(world.create<Mesh>(1000000).entities);
  auto reader = world.reader<Mesh>();
  drained(reader);
  std::vector<Entity> marked;
  for (std::size_t i = 0; i < 10000; ++i)
    marked.push_back(entities[i * 97 % entities.size()]);
  world.mark_changed<Mesh>(marked);
  std::ranges::sort(marked, {}, &Entity::index);
  EXPECT_EQ(drained(reader), marked) << "exactly the marked rows";
}

TEST(ChangeReader, NeighbouringRowsAreOneRun) {
  World world;
  const auto entities = copy(world.create<Mesh>(1000).entities);
  auto reader = world.reader<Mesh>();
  std::vector<std::size_t> runs;
  const auto note = [&](auto rows, auto) { runs.push_back(rows.size()); };
  reader.drain(note);
  world.mark_changed<Mesh>(std::span(entities).subspan(50, 200));
  world.mark_changed<Mesh>(entities[999]);
  reader.drain(note);
  EXPECT_EQ(runs, (std::vector<std::size_t>{1000, 200, 1}));
}

TEST(ChangeReader, ReadersDoNotSeeEachOther) {
  World world;
  const auto entities = copy(world.create<Mesh>(2).entities);
  auto first = world.reader<Mesh>();
  auto second = world.reader<Mesh>();
  EXPECT_EQ(drained(first).size(), 2U);
  world.mark_changed<Mesh>(entities[1]);
  EXPECT_EQ(drained(first).size(), 1U);
  EXPECT_EQ(drained(second).size(), 2U);
}

TEST(ChangeReader, AChangeFollowsItsEntityToAnotherRowAndArchetype) {
  World world;
  const auto entities = copy(world.create<Mesh>(100).entities);
  auto reader = world.reader<Mesh>();
  drained(reader);
  world.mark_changed<Mesh>(entities[99]);
  world.mark_changed<Mesh>(entities[98]);
  world.mark_changed<Mesh>(entities[0]);
  world.destroy(std::span(entities).first(10));  // 99 and 98 move into the holes
  world.add<Position>(std::span(entities).last(1));
  EXPECT_THAT(drained(reader), testing::UnorderedElementsAre(entities[98], entities[99]));
  world.create<Mesh>(0);
  EXPECT_TRUE(drained(reader).empty());
}

TEST(ChangeReader, DeadRowsLeaveNoMarkForTheirSuccessors) {
  World world;
  const auto entities = copy(world.create<Mesh>(10).entities);
  auto reader = world.reader<Mesh>();
  world.destroy(entities);
  EXPECT_TRUE(drained(reader).empty());
  const Entity only = world.create<Mesh>(1).entities[0];
  EXPECT_EQ(drained(reader), std::vector<Entity>{only});
}

TEST(ChangeReader, EntitiesThatDiedOrLostTheComponentAreReportedOnce) {
  World world;
  const auto entities = copy(world.create<Mesh, Position>(10).entities);
  const auto others = copy(world.create<Position>(3).entities);
  auto reader = world.reader<Mesh>(Removed::kReport);
  world.destroy(std::span(entities).first(2));
  world.destroy(others);
  world.remove<Mesh>(std::span(entities).last(1));
  world.remove<Position>(std::span(entities).subspan(3, 1));
  std::vector<Entity> removed;
  const auto note = [&](std::span<const Entity> gone) { removed = copy(gone); };
  EXPECT_EQ(reader.drain_removed(note), 3U);
  EXPECT_EQ(removed, (std::vector<Entity>{entities[0], entities[1], entities[9]}));
  EXPECT_EQ(reader.drain_removed(note), 0U);
}

TEST(ChangeReader, AMovedReaderEndsOnce) {
  World world;
  world.create<Mesh>(1);
  auto first = world.reader<Mesh>();
  {
    auto second = world.reader<Mesh>();
    auto third = std::move(second);
    EXPECT_EQ(drained(third).size(), 1U);
  }
  world.create<Mesh>(1);
  EXPECT_EQ(drained(first).size(), 2U);
}

}  // namespace
}  // namespace psygen::ecs
