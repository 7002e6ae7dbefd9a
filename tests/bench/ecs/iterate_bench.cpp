// Iteration over columns, and access to single values through handles.
#include <benchmark/benchmark.h>

#include "tests/bench/ecs/floor.hpp"

namespace psygen::ecs::bench {
namespace {

// One copy for library and floor, which differ in the lookup and the layout of their arrays.
[[gnu::noinline]] void integrate(Position* positions, const Velocity* velocities,
                                 std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    positions[i].x += velocities[i].x * 0.016F;
    positions[i].y += velocities[i].y * 0.016F;
    positions[i].z += velocities[i].z * 0.016F;
  }
}

[[gnu::noinline]] void integrate_light(Position* positions, const Velocity* velocities,
                                       const Mass* masses, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float step = 0.016F * masses[i].kilograms;
    positions[i].x += velocities[i].x * step;
    positions[i].y += velocities[i].y * step;
    positions[i].z += velocities[i].z * step;
  }
}

// Writes every row, so that no column is the kernel's page of zeros.
void touch(World& world) {
  world.each<Position>([](auto, auto rows) { std::ranges::fill(rows, Position{1, 1, 1}); });
  world.each<Velocity>([](auto, auto rows) { std::ranges::fill(rows, Velocity{1, 1, 1}); });
  world.each<Mass>([](auto, auto rows) { std::ranges::fill(rows, Mass{1}); });
  world.each<Mesh>([](auto, auto rows) { std::ranges::fill(rows, Mesh{1, 1}); });
}
void touch(FloorTable& table) {
  std::fill_n(table.positions.data(), table.rows, Position{1, 1, 1});
  std::fill_n(table.velocities.data(), table.rows, Velocity{1, 1, 1});
  std::fill_n(table.masses.data(), table.rows, Mass{1});
  std::fill_n(table.meshes.data(), table.rows, Mesh{1, 1});
}

void per_entity(benchmark::State& state, std::size_t entities) {
  state.SetItemsProcessed(static_cast<std::int64_t>(entities) * state.iterations());
}

void iterate_2(benchmark::State& state) {
  World world;
  world.create<Position, Velocity>(kEntities);
  touch(world);
  for (auto _ : state) {
    world.each<Position, const Velocity>([](auto, auto positions, auto velocities) {
      integrate(positions.data(), velocities.data(), positions.size());
    });
    benchmark::ClobberMemory();
  }
  per_entity(state, kEntities);
}
BENCHMARK(iterate_2)->Name("iterate_2/ecs");

void iterate_2_floor(benchmark::State& state) {
  FloorTable table;
  table.create(kEntities);
  touch(table);
  for (auto _ : state) {
    integrate(table.positions.data(), table.velocities.data(), table.rows);
    benchmark::ClobberMemory();
  }
  per_entity(state, kEntities);
}
BENCHMARK(iterate_2_floor)->Name("iterate_2/floor");

void iterate_3_half(benchmark::State& state) {
  World world;
  world.create<Position, Velocity, Mass>(kEntities / 2);
  world.create<Position, Velocity>(kEntities / 2);
  touch(world);
  for (auto _ : state) {
    world.each<Position, const Velocity, const Mass>(
        [](auto, auto positions, auto velocities, auto masses) {
          integrate_light(positions.data(), velocities.data(), masses.data(), positions.size());
        });
    benchmark::ClobberMemory();
  }
  per_entity(state, kEntities / 2);
}
BENCHMARK(iterate_3_half)->Name("iterate_3_half_match/ecs");

void iterate_3_half_floor(benchmark::State& state) {
  FloorTable table;
  table.create(kEntities / 2);
  touch(table);
  for (auto _ : state) {
    integrate_light(table.positions.data(), table.velocities.data(), table.masses.data(),
                    table.rows);
    benchmark::ClobberMemory();
  }
  per_entity(state, kEntities / 2);
}
BENCHMARK(iterate_3_half_floor)->Name("iterate_3_half_match/floor");

void random_get(benchmark::State& state) {
  World world;
  const auto entities = permuted(world.create<Position, Mesh>(kEntities).entities, 1);
  touch(world);
  const Accessor<const Mesh> meshes = world.accessor<const Mesh>();
  for (auto _ : state) {
    std::uint64_t sum = 0;
    for (const Entity entity : entities) {
      if (const Mesh* mesh = meshes.get(entity)) sum += mesh->id;
    }
    benchmark::DoNotOptimize(sum);
  }
  per_entity(state, kEntities);
}
BENCHMARK(random_get)->Name("random_get/ecs");

void random_get_each(benchmark::State& state) {
  World world;
  const auto entities = permuted(world.create<Position, Mesh>(kEntities).entities, 1);
  touch(world);
  const Accessor<const Mesh> meshes = world.accessor<const Mesh>();
  for (auto _ : state) {
    std::uint64_t sum = 0;
    meshes.each(entities, [&](std::size_t, const Mesh* mesh) {
      if (mesh != nullptr) sum += mesh->id;
    });
    benchmark::DoNotOptimize(sum);
  }
  per_entity(state, kEntities);
}
BENCHMARK(random_get_each)->Name("random_get_each/ecs");

void random_get_floor(benchmark::State& state) {
  FloorTable table;
  table.create(kEntities);
  touch(table);
  const auto entities = permuted(std::span<const Entity>(table.entities.data(), kEntities), 1);
  for (auto _ : state) {
    std::uint64_t sum = 0;
    for (const Entity entity : entities) {
      if (table.alive(entity)) sum += table.meshes[table.slots[entity.index].row].id;
    }
    benchmark::DoNotOptimize(sum);
  }
  per_entity(state, kEntities);
}
BENCHMARK(random_get_floor)->Name("random_get/floor");
BENCHMARK(random_get_floor)->Name("random_get_each/floor");

}  // namespace
}  // namespace psygen::ecs::bench
