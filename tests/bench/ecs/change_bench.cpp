// Batched writes of results, scattered change marks, and draining them.
#include <benchmark/benchmark.h>

#include <chrono>

#include "tests/bench/ecs/floor.hpp"

namespace psygen::ecs::bench {
namespace {

constexpr std::size_t kResults = 1000;
constexpr std::size_t kMarks = 10'000;

void per_entity(benchmark::State& state, std::size_t entities) {
  state.SetItemsProcessed(static_cast<std::int64_t>(entities) * state.iterations());
}

// A thousand batches of results; a tenth of the entities are dead.
template <class Target>
std::vector<Landing<Mesh>> make_results(Target& target, std::span<const Entity> all) {
  std::vector<Entity> entities = permuted(all, 4);
  const std::vector<Entity> gone = permuted(all.first(kEntities / 10), 5);
  target.destroy(gone);
  std::vector<Landing<Mesh>> results;
  for (const Entity entity : entities)
    results.push_back({entity, {entity.index, 1}});
  return results;
}

template <class Target, class Land>
void land_batches(benchmark::State& state, Target& target, std::span<const Entity> all,
                  Land&& land) {
  const std::vector<Entity> copy(all.begin(), all.end());
  const auto results = make_results(target, copy);
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(land(std::span(results).subspan(next, kResults)));
    next = (next + kResults) % results.size();
  }
  per_entity(state, kResults);
}

void land(benchmark::State& state) {
  World world;
  const auto all = world.create<Position, Velocity, Mass, Mesh>(kEntities).entities;
  const auto reader = world.reader<Mesh>();
  land_batches(state, world, all, [&](auto results) { return world.land<Mesh>(results).landed; });
}
BENCHMARK(land)->Name("land_1000_tenth_stale/ecs");

void land_floor(benchmark::State& state) {
  FloorTable table;
  table.create(kEntities);
  std::vector<std::uint64_t> bits(kEntities / 64 + 1);
  land_batches(state, table, {table.entities.data(), kEntities}, [&](auto results) {
    std::size_t landed = 0;
    for (const auto& [entity, value] : results) {
      if (!table.alive(entity)) continue;
      const std::uint32_t row = table.slots[entity.index].row;
      table.meshes[row] = value;
      bits[row / 64] |= std::uint64_t{1} << (row % 64);
      ++landed;
    }
    return landed;
  });
}
BENCHMARK(land_floor)->Name("land_1000_tenth_stale/floor");

using Seconds = std::chrono::duration<double>;
double seconds_since(std::chrono::steady_clock::time_point begin) {
  return Seconds(std::chrono::steady_clock::now() - begin).count();
}

// Marks 10,000 of a million and drains them; `which` selects the half whose time counts.
enum Half { kMark, kDrain };
template <Half which>
void changes(benchmark::State& state) {
  World world;
  const auto all = permuted(world.create<Position, Mesh>(kEntities).entities, 6);
  auto reader = world.reader<Mesh>();
  reader.drain([](auto, auto) {});
  std::size_t next = 0;
  std::size_t visited = 0;
  std::uint64_t sum = 0;
  for (auto _ : state) {
    auto begin = std::chrono::steady_clock::now();
    world.mark_changed<Mesh>(std::span(all).subspan(next, kMarks));
    if (which == kMark) state.SetIterationTime(seconds_since(begin));
    begin = std::chrono::steady_clock::now();
    visited = reader.drain([&](auto, std::span<const Mesh> meshes) {
      for (const Mesh& mesh : meshes)
        sum += mesh.id;
    });
    if (which == kDrain) state.SetIterationTime(seconds_since(begin));
    next = (next + kMarks) % kEntities;
  }
  benchmark::DoNotOptimize(sum);
  if (visited != kMarks) state.SkipWithError("the drain did not visit exactly the marked rows");
  per_entity(state, kMarks);
}
BENCHMARK(changes<kMark>)->Name("mark_10k_scattered/ecs")->UseManualTime();
BENCHMARK(changes<kDrain>)->Name("drain_10k_scattered/ecs")->UseManualTime();

template <Half which>
void changes_floor(benchmark::State& state) {
  FloorTable table;
  table.create(kEntities);
  std::memset(static_cast<void*>(table.meshes.data()), 0, kEntities * sizeof(Mesh));
  const auto all = permuted(std::span<const Entity>(table.entities.data(), kEntities), 6);
  std::vector<std::uint64_t> bits(kEntities / 64 + 1);
  std::size_t next = 0;
  std::uint64_t sum = 0;
  for (auto _ : state) {
    auto begin = std::chrono::steady_clock::now();
    for (const Entity entity : std::span(all).subspan(next, kMarks)) {
      if (!table.alive(entity)) continue;
      const std::uint32_t row = table.slots[entity.index].row;
      bits[row / 64] |= std::uint64_t{1} << (row % 64);
    }
    if (which == kMark) state.SetIterationTime(seconds_since(begin));
    begin = std::chrono::steady_clock::now();
    for (std::size_t w = 0; w < bits.size(); ++w) {
      for (; bits[w] != 0; bits[w] &= bits[w] - 1) {
        sum += table.meshes[w * 64 + static_cast<std::size_t>(std::countr_zero(bits[w]))].id;
      }
    }
    if (which == kDrain) state.SetIterationTime(seconds_since(begin));
    next = (next + kMarks) % kEntities;
  }
  benchmark::DoNotOptimize(sum);
  per_entity(state, kMarks);
}
BENCHMARK(changes_floor<kMark>)->Name("mark_10k_scattered/floor")->UseManualTime();
BENCHMARK(changes_floor<kDrain>)->Name("drain_10k_scattered/floor")->UseManualTime();

}  // namespace
}  // namespace psygen::ecs::bench
