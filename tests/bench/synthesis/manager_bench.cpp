// What a request costs beside its synthesis: claim, clocks, completion, collection.
#include <benchmark/benchmark.h>

#include "engine/core/clock.hpp"
#include "engine/synthesis/planner.hpp"
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
  SynthesisManager manager(
      registry, {.modelers = static_cast<unsigned>(state.range(0)), .lowest_priority = false});
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
BENCHMARK(requests_through_manager)->Arg(1)->Arg(2)->UseRealTime();

// A tick's worth of re-planning while a modeler works: close, sort, carry over, publish.
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
