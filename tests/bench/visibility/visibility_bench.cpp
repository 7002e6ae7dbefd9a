// How long visibility takes: PLP over about 100,000 blocks, box tests against the frustum, choosing
// levels. Run with --benchmark_repetitions=9 and read the medians.
#include <benchmark/benchmark.h>

#include "engine/visibility/level_choice.hpp"
#include "engine/visibility/plp.hpp"
#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

testing::GridScene scene_of(std::uint32_t side, double height_m) {
  const auto middle = static_cast<std::int32_t>(side / 2);
  return {side, side, {{{middle, middle}, {20, height_m, 40}}, 0.7, -0.05}};
}

std::vector<float> random_solidity(std::size_t count) {
  core::RandomStream random(9, 0, 0, 0, core::Purpose::kStructure);
  std::vector<float> solidity;
  while (solidity.size() < count)
    solidity.push_back(static_cast<float>(random.next_unit()));
  return solidity;
}

void plp_visits_every_cell(benchmark::State& state) {
  const auto side = static_cast<std::uint32_t>(state.range(0));
  const testing::GridScene scene = scene_of(side, static_cast<double>(state.range(1)));
  const std::vector<float> solidity = random_solidity(scene.bounds.size());
  const PlpMode mode = state.range(2) == 0 ? PlpMode::kLayers : PlpMode::kSolidity;
  PlpResult result;
  for (auto _ : state) {
    run_plp(
        {side, side, side / 2, side / 2, scene.bounds, &scene.frustum, UINT32_MAX, mode, solidity},
        result);
    benchmark::DoNotOptimize(result.visible.data());
  }
  state.SetItemsProcessed(state.iterations() * side * side);
}
BENCHMARK(plp_visits_every_cell)
    ->ArgNames({"side", "height_m", "solidity"})
    ->ArgsProduct({{33, 317}, {20, 600}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

void frustum_tests_boxes(benchmark::State& state) {
  const testing::GridScene scene = scene_of(64, 20);
  std::vector<std::uint8_t> in_view(scene.bounds.size());
  for (auto _ : state) {
    intersects(scene.frustum, scene.bounds, in_view);
    benchmark::DoNotOptimize(in_view.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(in_view.size()));
}
BENCHMARK(frustum_tests_boxes);

void levels_are_chosen(benchmark::State& state) {
  constexpr std::size_t kCount = 4096;
  std::vector<float> errors, distances;
  for (std::size_t i = 0; i < kCount; ++i) {
    errors.insert(errors.end(), {0.0F, 0.1F, 0.3F, 0.9F, 2.7F});
    distances.push_back(static_cast<float>(i));
  }
  std::vector<std::uint8_t> levels(kCount, kNoCurrentLevel);
  for (auto _ : state) {
    choose_levels(errors, 5, distances, 745, 2, levels);
    benchmark::DoNotOptimize(levels.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}
BENCHMARK(levels_are_chosen);

}  // namespace
}  // namespace psygen::visibility

BENCHMARK_MAIN();
