// Lookups, ranking, and the life cycle of a mesh with and without pressure on the budget.
#include <benchmark/benchmark.h>

#include "engine/synthesis/geometry_cache.hpp"
#include "tests/bench/synthesis/bench_model.hpp"

namespace psygen::synthesis::bench {
namespace {

constexpr std::uint32_t kMeshes = 50'000;
constexpr std::uint64_t kMeshBytes = 1600;

struct FullCache {
  models::Registry registry = trivial_registry();
  CountingMemory memory;
  GeometryCache cache{memory, registry, kMeshes* kMeshBytes};
  models::Parameters parameters = vertices_of(100);
  std::vector<MeshHandle> handles;

  FullCache() {
    for (std::uint32_t i = 0; i < kMeshes; ++i) {
      handles.push_back(*cache.reserve(key_of(i), parameters, i, rank(i)));
      cache.complete(handles.back(), {});
    }
  }
  static Rank rank(std::uint32_t i) {
    return Rank::by_layer(RankGroup::kPrefetch, i % 61, static_cast<float>(i % 997));
  }
};

void find(benchmark::State& state) {
  const FullCache full;
  std::uint32_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(full.cache.find(key_of((i += 7919) % kMeshes)));
}
BENCHMARK(find);

void set_rank(benchmark::State& state) {
  FullCache full;
  std::uint32_t i = 0;
  for (auto _ : state) {
    ++i;
    full.cache.set_rank(full.handles[i % kMeshes], FullCache::rank(i / kMeshes + i));
  }
}
BENCHMARK(set_rank);

void reserve_complete_release(benchmark::State& state) {
  const models::Registry registry = trivial_registry();
  CountingMemory memory;
  GeometryCache cache(memory, registry, kMeshes * kMeshBytes);
  const models::Parameters p = vertices_of(100);
  std::uint32_t i = 0;
  for (auto _ : state) {
    ++i;
    const MeshHandle handle = *cache.reserve(key_of(i), p, i, Rank::unwanted());
    cache.complete(handle, {});
    cache.release(handle);
  }
}
BENCHMARK(reserve_complete_release);

// Ticks with `range` new meshes in a full cache: each new mesh evicts the worst one.
void reserve_under_pressure(benchmark::State& state) {
  FullCache full;
  const auto batch = static_cast<std::uint32_t>(state.range(0));
  std::uint32_t next = kMeshes;
  std::vector<MeshHandle> reserved;
  for (auto _ : state) {
    full.cache.begin_batch();
    reserved.clear();
    for (std::uint32_t i = 0; i < batch; ++i, ++next) {
      const auto handle = full.cache.reserve(key_of(next), full.parameters, next,
                                             Rank::by_layer(RankGroup::kVisibleHole, 0, 1));
      if (handle) reserved.push_back(*handle);
    }
    for (const MeshHandle handle : reserved) {
      full.cache.complete(handle, {});
      full.cache.set_rank(handle, FullCache::rank(next));
    }
    benchmark::DoNotOptimize(full.cache.take_evictions().size());
  }
  state.SetItemsProcessed(state.iterations() * batch);
}
BENCHMARK(reserve_under_pressure)->Arg(1)->Arg(100)->Arg(1000);

}  // namespace
}  // namespace psygen::synthesis::bench
