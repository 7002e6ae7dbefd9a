#include "ecs/query.hpp"

#include <gtest/gtest.h>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(Query, EachVisitsEveryMatchingTableOnceWithParallelSpans) {
  World world;
  world.create<Position>(10);
  world.create<Position, Velocity>(20);
  world.create<Position, Velocity, Health>(30);
  world.create<Velocity>(40);
  std::size_t calls = 0;
  std::size_t rows = 0;
  world.each<Position, const Velocity>([&](std::span<const Entity> entities,
                                           std::span<Position> positions,
                                           std::span<const Velocity> velocities) {
    ++calls;
    rows += entities.size();
    EXPECT_EQ(positions.size(), entities.size());
    EXPECT_EQ(velocities.size(), entities.size());
    for (std::size_t i = 0; i < entities.size(); ++i) {
      EXPECT_EQ(world.get<Position>(entities[i]), &positions[i]);
      EXPECT_EQ(world.get<Velocity>(entities[i]), &velocities[i]);
    }
  });
  EXPECT_EQ(calls, 2U);
  EXPECT_EQ(rows, 50U);
}

TEST(Query, WithoutSkipsTables) {
  World world;
  world.create<Position>(10);
  world.create<Position, Hidden>(20);
  std::size_t rows = 0;
  world.each<const Position>(
      [&](std::span<const Entity> entities, auto) { rows += entities.size(); },
      Without<Hidden, Health>{});
  EXPECT_EQ(rows, 10U);
}

TEST(Query, AQueryWithoutComponentsVisitsAllEntities) {
  World world;
  world.create<Position>(10);
  world.create<Velocity>(5);
  std::size_t rows = 0;
  world.each<>([&](std::span<const Entity> entities) { rows += entities.size(); });
  EXPECT_EQ(rows, 15U);
}

TEST(Query, AConstWorldIsIteratedAndUnknownComponentsMatchNothing) {
  World world;
  world.create<Position>(3);
  const World& read_only = world;
  std::size_t rows = 0;
  read_only.each<const Position>([&](auto entities, auto) { rows += entities.size(); });
  read_only.each<const Mesh>([&](auto entities, auto) { rows += 100 + entities.size(); });
  EXPECT_EQ(rows, 3U);
  EXPECT_EQ(read_only.count<Mesh>(), 0U);
}

TEST(Query, EmptiedTablesAreNotVisited) {
  World world;
  const auto created = world.create<Position>(3);
  world.destroy(created.entities);
  world.each<Position>([](auto, auto) { FAIL() << "no row is left"; });
}

TEST(Query, RowsAreMarkedWhileTheyAreIterated) {
  World world;
  world.create<Mesh>(1000);
  auto reader = world.reader<Mesh>();
  reader.drain([](auto, auto) {});
  world.each<Mesh>([](TableRows<Mesh> rows, std::span<const Entity>, std::span<Mesh> meshes) {
    for (std::size_t i = 10; i < 20; ++i)
      meshes[i].id = i;
    rows.mark_changed<Mesh>(10, 10);
  });
  std::vector<std::uint64_t> ids;
  EXPECT_EQ(reader.drain([&](auto, std::span<const Mesh> meshes) {
    for (const Mesh& mesh : meshes)
      ids.push_back(mesh.id);
  }),
            10U);
  EXPECT_EQ(ids, (std::vector<std::uint64_t>{10, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
}

TEST(Query, EachOfGroupsNeighboursAndKeepsTheOrder) {
  World world;
  std::vector<Entity> all;
  const auto keep = [&](std::span<const Entity> entities) {
    all.insert(all.end(), entities.begin(), entities.end());
  };
  keep(world.create<Mesh, Position>(5000).entities);  // more than one chunk
  keep(world.create<Mesh>(10).entities);
  for (std::size_t i = 0; i < all.size(); ++i)
    world.get<Mesh>(all[i])->id = i;
  const auto visit = [&](std::span<const Entity> asked) {
    std::vector<std::size_t> runs;
    std::vector<std::uint64_t> ids;
    const std::size_t visited = world.each_of<const Mesh>(
        asked, [&](std::span<const Entity> entities, std::span<const Mesh> meshes) {
          runs.push_back(meshes.size());
          for (std::size_t i = 0; i < meshes.size(); ++i) {
            EXPECT_EQ(entities[i], all[meshes[i].id]);
            ids.push_back(meshes[i].id);
          }
        });
    EXPECT_EQ(visited, ids.size());
    return std::pair(runs, ids);
  };
  EXPECT_EQ(visit(all).first, (std::vector<std::size_t>{5000, 10}));
  EXPECT_EQ(visit(std::vector{all[7], all[8], all[3], all[5001], all[4]}),
            (std::pair(std::vector<std::size_t>{2, 1, 1, 1},
                       std::vector<std::uint64_t>{7, 8, 3, 5001, 4})));
  EXPECT_EQ(visit({}).first.size(), 0U);
  const std::vector<Entity> some{all[1], Entity{}, all[2]};
  EXPECT_EQ(visit(some).first, std::vector<std::size_t>{2});  // the stale one is no gap
  EXPECT_EQ((world.each_of<const Mesh, const Position>(all, [](auto, auto, auto) {})), 5000U);
  EXPECT_EQ(world.each_of<const Velocity>(all, [](auto, auto) { FAIL(); }), 0U);
}

TEST(Query, EachOfMarksTheRowsItVisits) {
  World world;
  const auto created = world.create<Mesh>(10).entities;
  const std::vector<Entity> all(created.begin(), created.end());
  auto reader = world.reader<Mesh>();
  reader.drain([](auto, auto) {});
  world.each_of<Mesh>(std::span(all).subspan(4, 3),
                      [](TableRows<Mesh> rows, auto, auto) { rows.mark_changed<Mesh>(2, 1); });
  reader.drain([&](std::span<const Entity> entities, auto) { EXPECT_EQ(entities[0], all[6]); });
}

}  // namespace
}  // namespace psygen::ecs
