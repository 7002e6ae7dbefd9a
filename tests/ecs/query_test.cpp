#include "ecs/query.hpp"

#include <gtest/gtest.h>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

TEST(Query, each_visits_every_matching_table_once_with_parallel_spans) {
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

TEST(Query, without_leaves_tables_out) {
  World world;
  world.create<Position>(10);
  world.create<Position, Hidden>(20);
  std::size_t rows = 0;
  world.each<const Position>(
      [&](std::span<const Entity> entities, auto) { rows += entities.size(); },
      Without<Hidden, Health>{});
  EXPECT_EQ(rows, 10U);
}

TEST(Query, a_query_for_nothing_visits_everybody) {
  World world;
  world.create<Position>(10);
  world.create<Velocity>(5);
  std::size_t rows = 0;
  world.each<>([&](std::span<const Entity> entities) { rows += entities.size(); });
  EXPECT_EQ(rows, 15U);
}

TEST(Query, a_const_world_is_iterated_and_unknown_components_match_nothing) {
  World world;
  world.create<Position>(3);
  const World& read_only = world;
  std::size_t rows = 0;
  read_only.each<const Position>([&](auto entities, auto) { rows += entities.size(); });
  read_only.each<const Mesh>([&](auto entities, auto) { rows += 100 + entities.size(); });
  EXPECT_EQ(rows, 3U);
  EXPECT_EQ(read_only.count<Mesh>(), 0U);
}

TEST(Query, emptied_tables_are_not_visited) {
  World world;
  const auto created = world.create<Position>(3);
  world.destroy(created.entities);
  world.each<Position>([](auto, auto) { FAIL() << "no row is left"; });
}

TEST(Query, rows_are_marked_while_they_are_iterated) {
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

}  // namespace
}  // namespace psygen::ecs
