// Batched creation, destruction and changes of archetype. Manual timing excludes the creation and
// destruction of worlds.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "tests/bench/ecs/floor.hpp"

namespace psygen::ecs::bench {
namespace {

template <class F>
void timed(benchmark::State& state, F&& f) {
  const auto begin = std::chrono::steady_clock::now();
  f();
  const auto end = std::chrono::steady_clock::now();
  state.SetIterationTime(std::chrono::duration<double>(end - begin).count());
}

void per_entity(benchmark::State& state, std::size_t entities) {
  state.SetItemsProcessed(static_cast<std::int64_t>(entities) * state.iterations());
}

template <class P, class V, class M, class H>
void fill(P* positions, V* velocities, M* masses, H* meshes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    positions[i] = {1, 2, 3};
  for (std::size_t i = 0; i < count; ++i)
    velocities[i] = {4, 5, 6};
  for (std::size_t i = 0; i < count; ++i)
    masses[i] = {7};
  for (std::size_t i = 0; i < count; ++i)
    meshes[i] = {i, 0};
}

void create_filled(World& world, std::size_t count) {
  const auto created = world.create<Position, Velocity, Mass, Mesh>(count);
  fill(created.column<Position>().data(), created.column<Velocity>().data(),
       created.column<Mass>().data(), created.column<Mesh>().data(), count);
}

void create_filled(FloorTable& table, std::size_t count) {
  const std::size_t first = table.create(count);
  fill(&table.positions[first], &table.velocities[first], &table.masses[first],
       &table.meshes[first], count);
}

std::vector<Entity> all_entities(World& world) {
  std::vector<Entity> all;
  world.each<>([&](auto entities) { all.insert(all.end(), entities.begin(), entities.end()); });
  return all;
}
std::vector<Entity> all_entities(FloorTable& table) {
  return {table.entities.data(), table.entities.data() + table.rows};
}

template <class Target>
void bulk_create(benchmark::State& state) {
  for (auto _ : state) {
    Target target;
    timed(state, [&] { create_filled(target, kEntities); });
  }
  per_entity(state, kEntities);
}
BENCHMARK(bulk_create<World>)->Name("bulk_create_4/ecs")->UseManualTime();
BENCHMARK(bulk_create<FloorTable>)->Name("bulk_create_4/floor")->UseManualTime();

template <class Target>
void destroy_all(benchmark::State& state) {
  for (auto _ : state) {
    Target target;
    create_filled(target, kEntities);
    const auto order = permuted(std::span<const Entity>(all_entities(target)), 2);
    timed(state, [&] { target.destroy(order); });
  }
  per_entity(state, kEntities);
}
BENCHMARK(destroy_all<World>)->Name("destroy_random_all/ecs")->UseManualTime();
BENCHMARK(destroy_all<FloorTable>)->Name("destroy_random_all/floor")->UseManualTime();

template <class Target>
void destroy_half(benchmark::State& state) {
  for (auto _ : state) {
    Target target;
    create_filled(target, kEntities);
    const auto order = permuted(std::span<const Entity>(all_entities(target)), 2);
    timed(state, [&] { target.destroy(std::span(order).first(kEntities / 2)); });
  }
  per_entity(state, kEntities / 2);
}
BENCHMARK(destroy_half<World>)->Name("destroy_random_half/ecs")->UseManualTime();
BENCHMARK(destroy_half<FloorTable>)->Name("destroy_random_half/floor")->UseManualTime();

template <class Target>
void churn(benchmark::State& state) {
  constexpr std::size_t kPairs = 1000;
  Target target;
  create_filled(target, kEntities);
  std::uint32_t seed = 0;
  std::vector<Entity> all;
  std::size_t next = 0;
  for (auto _ : state) {
    if (next + kPairs > all.size()) {  // a new random order of all entities
      all = permuted(std::span<const Entity>(all_entities(target)), ++seed);
      next = 0;
    }
    timed(state, [&] {
      target.destroy(std::span(all).subspan(next, kPairs));
      create_filled(target, kPairs);
    });
    next += kPairs;
  }
  per_entity(state, kPairs);
}
BENCHMARK(churn<World>)->Name("destroy_create_1000_in_1M/ecs")->UseManualTime();
BENCHMARK(churn<FloorTable>)->Name("destroy_create_1000_in_1M/floor")->UseManualTime();

// Adds and removes a component of a tenth of the world in random order. Its storage is sparse or a
// table column; the floor keeps one bit per entity and checks handles.
enum Toggle { kAdd, kRemove };
template <class C, Toggle which>
void toggle(benchmark::State& state) {
  World world;
  create_filled(world, kEntities);
  const auto order = permuted(std::span<const Entity>(all_entities(world)), 3);
  std::size_t next = 0;
  constexpr std::size_t kToggled = kEntities / 10;
  for (auto _ : state) {
    const auto some = std::span(order).subspan(next, kToggled);
    next = (next + kToggled) % kEntities;
    const auto adding = [&] { world.add<C>(some); };
    const auto removing = [&] { world.remove<C>(some); };
    if constexpr (which == kAdd) {
      timed(state, adding);
      removing();
    } else {
      adding();
      timed(state, removing);
    }
  }
  per_entity(state, kToggled);
}
BENCHMARK(toggle<Selected, kAdd>)->Name("add_sparse_random/ecs")->UseManualTime();
BENCHMARK(toggle<Selected, kRemove>)->Name("remove_sparse_random/ecs")->UseManualTime();
BENCHMARK(toggle<Moved, kAdd>)->Name("add_by_moving_rows/ecs")->UseManualTime();
BENCHMARK(toggle<Moved, kRemove>)->Name("remove_by_moving_rows/ecs")->UseManualTime();

template <Toggle which>
void toggle_floor(benchmark::State& state) {
  FloorTable table;
  create_filled(table, kEntities);
  const auto order = permuted(std::span<const Entity>(all_entities(table)), 3);
  std::vector<std::uint32_t> place(kEntities, UINT32_MAX);
  std::vector<Entity> members(kEntities);
  std::vector<Selected> values(kEntities);
  std::size_t count = 0;
  const auto add = [&](std::span<const Entity> some) {
    for (const Entity e : some) {
      if (!table.alive(e) || place[e.index] != UINT32_MAX) continue;
      place[e.index] = static_cast<std::uint32_t>(count);
      members[count] = e;
      values[count++] = {};
    }
  };
  const auto remove = [&](std::span<const Entity> some) {
    for (const Entity e : some) {
      const std::uint32_t at = place[e.index];
      if (at == UINT32_MAX || members[at] != e) continue;
      members[at] = members[--count];
      values[at] = values[count];
      place[members[at].index] = at;
      place[e.index] = UINT32_MAX;
    }
  };
  std::size_t next = 0;
  constexpr std::size_t kToggled = kEntities / 10;
  for (auto _ : state) {
    const auto some = std::span(order).subspan(next, kToggled);
    next = (next + kToggled) % kEntities;
    if constexpr (which == kAdd) {
      timed(state, [&] { add(some); });
      remove(some);
    } else {
      add(some);
      timed(state, [&] { remove(some); });
    }
  }
  per_entity(state, kToggled);
}
BENCHMARK(toggle_floor<kAdd>)->Name("add_sparse_random/floor")->UseManualTime();
BENCHMARK(toggle_floor<kRemove>)->Name("remove_sparse_random/floor")->UseManualTime();

std::size_t resident_bytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  std::size_t total = 0;
  std::size_t resident = 0;
  const int fields = std::fscanf(file, "%zu %zu", &total, &resident);
  std::fclose(file);
  return fields == 2 ? resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

// Resident bytes per entity with 64 bytes of components.
struct Payload {
  std::uint64_t words[4];
};
struct Cargo {
  std::uint64_t words[4];
};
void memory(benchmark::State& state) {
  for (auto _ : state) {
    const std::size_t before = resident_bytes();
    World world;
    world.create<Payload, Cargo>(kEntities);
    world.each<Payload, Cargo>([](auto, auto payloads, auto cargoes) {
      for (auto& payload : payloads)
        payload.words[0] = 1;
      for (auto& cargo : cargoes)
        cargo.words[0] = 1;
    });
    state.counters["bytes_per_entity"] =
        static_cast<double>(resident_bytes() - before) / static_cast<double>(kEntities);
  }
}
BENCHMARK(memory)->Name("memory_64_byte_payload/ecs")->Iterations(1);

// A million entities with two described components, to bytes and back.
void save(benchmark::State& state) {
  World world;
  world.create<Described, Position>(kEntities);
  for (auto _ : state)
    benchmark::DoNotOptimize(save_snapshot(world));
  per_entity(state, kEntities);
}
BENCHMARK(save)->Name("save_snapshot/ecs");

void load(benchmark::State& state) {
  World saved;
  saved.create<Described, Position>(kEntities);
  const std::vector<std::byte> bytes = save_snapshot(saved);
  for (auto _ : state) {
    World world;
    world.declare<Described, Position>();
    bool loaded = false;
    timed(state, [&] { loaded = bool(load_snapshot(bytes, world)); });
    if (!loaded) state.SkipWithError("the snapshot was refused");
  }
  per_entity(state, kEntities);
}
BENCHMARK(load)->Name("load_snapshot/ecs")->UseManualTime();

}  // namespace
}  // namespace psygen::ecs::bench
