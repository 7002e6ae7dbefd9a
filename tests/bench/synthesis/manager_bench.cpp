// Overhead of a request beyond its synthesis: claim, clocks, completion, collection.
#include <benchmark/benchmark.h>

#include "engine/core/clock.hpp"
#include "engine/synthesis/planner.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/bench/synthesis/bench_model.hpp"

namespace psygen::synthesis::bench {
namespace {

std::vector<Request> trivial_plan(std::uint32_t count) {
  std::vector<Request> plan(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    plan[i].key = key_of(i);
    plan[i].handle = {i, 1};
  }
  return plan;
}

void requests_through_manager(benchmark::State& state) {
  constexpr std::uint32_t kCount = 20'000;
  const models::Registry registry = trivial_registry();
  SynthesisManager manager(registry, {.modelers = static_cast<unsigned>(state.range(0))});
  const std::vector<Request> plan = trivial_plan(kCount);
  std::vector<Completion> done;
  for (auto _ : state) {
    manager.publish(std::vector<Request>(plan));
    manager.wait_all();
    done.clear();
    manager.collect(done);
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}
BENCHMARK(requests_through_manager)->RangeMultiplier(2)->Range(1, 16)->UseRealTime();

// Throughput of trees by number of modelers, with one destination each. Growing CPU seconds per
// tree would be contention; elapsed seconds that do not fall show a lack of processors. The
// destinations take 35 MB at LOD 0, more than the processor's caches, and 17 MB at LOD 2.
void trees_through_manager(benchmark::State& state) {
  const int level = static_cast<int>(state.range(1));
  const std::uint32_t count = level == 0 ? 512 : 2048;
  const models::Registry registry = models::make_standard_registry();
  const auto tree = static_cast<models::ModelIndex>(registry.find("tree"));
  SynthesisManager manager(registry, {.modelers = static_cast<unsigned>(state.range(0))});
  std::vector<HeapDestination> destinations;
  std::vector<Request> plan(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Request& request = plan[i];
    request.key = {{}, i, tree, static_cast<std::uint16_t>(level), i};
    request.handle = {i, 1};
    request.parameters = models::default_parameters(registry[tree]);
    request.parameters.set_integer(0, i);  // the seed
    destinations.push_back(*HeapDestination::make(registry[tree], request.parameters, level));
    request.size = destinations.back().size();
    request.destination = destinations.back().view();
  }
  std::vector<Completion> done;
  for (auto _ : state) {
    manager.publish(std::vector<Request>(plan));
    manager.wait_all();
    done.clear();
    manager.collect(done);
  }
  const SynthesisStats stats = manager.stats();
  state.SetItemsProcessed(state.iterations() * count);
  state.counters["cpu_us_per_tree"] = stats.cpu_seconds * 1e6 / static_cast<double>(stats.models);
}
BENCHMARK(trees_through_manager)
    ->ArgNames({"modelers", "level"})
    ->ArgsProduct({{1, 2, 4, 8, 16}, {0, 2}})
    ->UseRealTime();

// Re-planning of one tick while a modeler works: close, sort, carry over, publish.
void plan_with_carried_requests(benchmark::State& state) {
  const auto count = static_cast<std::uint32_t>(state.range(0));
  const models::Registry registry = trivial_registry();
  CountingMemory memory;
  GeometryCache cache(memory, registry, UINT64_MAX / 2);
  const CostModel cost(registry);
  SynthesisManager manager(registry, {.modelers = 1});
  Planner planner;
  const models::Parameters p = vertices_of(100);
  std::vector<Want> wants;
  for (std::uint32_t i = 0; i < count; ++i) {
    wants.push_back({key_of(i), &p, i,
                     Rank::by_layer(RankGroup::kPrefetch, i % 50, static_cast<float>(i % 977))});
  }
  std::vector<Completion> done;
  for (auto _ : state)
    planner.plan(wants, cache, cost, manager, {1e9, count, 16});
  state.SetItemsProcessed(state.iterations() * count);
  manager.reclaim();
}
BENCHMARK(plan_with_carried_requests)->Arg(1000)->Arg(10000);

void clock_of_the_thread(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(core::thread_cpu_seconds());
}
BENCHMARK(clock_of_the_thread);

}  // namespace
}  // namespace psygen::synthesis::bench
