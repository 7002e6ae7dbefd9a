// How long visibility takes: PLP over about 100,000 blocks, box tests against the frustum and the
// horizon, the cut through the quadtree, choosing levels. Run with --benchmark_repetitions=9 and
// read the medians.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/visibility/horizon.hpp"
#include "engine/visibility/level_choice.hpp"
#include "engine/visibility/plp.hpp"
#include "engine/visibility/quadtree.hpp"
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

// Hilly ground, 30 m below the camera on average.
float hills(float x, float z) {
  return 40 * std::sin(x * 0.004F) * std::cos(z * 0.005F) + 15 * std::sin(x * 0.021F + z * 0.017F) -
         70;
}

// Nodes around the camera, twice as large at twice the distance, nearest first.
std::vector<core::Bounds> nodes_around(std::size_t count) {
  core::RandomStream random(10, 0, 0, 0, core::Purpose::kPosition);
  std::vector<core::Bounds> nodes;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = random.next_real(0, 6.2832),
                 distance = 64 * std::exp2(7 * static_cast<double>(i) / static_cast<double>(count));
    const auto x = static_cast<float>(distance * std::cos(turn)),
               z = static_cast<float>(distance * std::sin(turn)),
               side = static_cast<float>(distance / 3), ground = hills(x, z);
    nodes.push_back({{x, ground - 10, z}, {x + side, ground + 15, z + side}});
  }
  return nodes;
}

void horizon_is_built_and_asked(benchmark::State& state) {
  const std::vector<core::Bounds> nodes = nodes_around(2000);
  const auto lines = static_cast<std::size_t>(state.range(0));
  std::vector<std::vector<glm::vec3>> rows;
  for (std::size_t i = 0; i < lines; ++i) {
    const core::Bounds& node = nodes[i * nodes.size() / lines];
    std::vector<glm::vec3> row;
    for (int k = 0; k < 22; ++k) {
      const float f = static_cast<float>(k) / 21, x = std::lerp(node.min.x, node.max.x, f);
      row.emplace_back(x, hills(x, node.max.z), node.max.z);
    }
    rows.push_back(row);
  }
  Horizon horizon;
  std::size_t hidden = 0;
  for (auto _ : state) {
    horizon.reset();
    hidden = 0;
    for (std::size_t i = 0, line = 0; i < nodes.size(); ++i) {
      hidden += horizon.hides(nodes[i]) ? 1 : 0;
      if (line < lines && line * nodes.size() <= i * lines) horizon.add(rows[line++], 0.1F);
    }
    benchmark::DoNotOptimize(hidden);
  }
  state.counters["hidden"] = static_cast<double>(hidden);
}
BENCHMARK(horizon_is_built_and_asked)
    ->ArgName("lines")
    ->Arg(0)
    ->Arg(200)
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);

void cut_is_selected(benchmark::State& state) {
  const double view_m = static_cast<double>(state.range(0)) * 1000;
  std::vector<double> errors;
  for (double error = 0.2; errors.size() < 8; error *= 2)
    errors.push_back(error);
  std::vector<LevelDistances> levels(8);
  split_distances(errors, {.pixels_per_radian = 745}, levels);
  CutInput input;
  input.camera = {{1000, -2000}, {20, 30, 40}};
  input.levels = levels;
  input.view_distance_m = view_m;
  std::vector<NodeCoord> roots;
  roots_around(input.camera, input.block_size_m, view_m, 7, roots);
  input.roots = roots;
  Cut cut;
  for (auto _ : state) {
    select_cut(input, cut);
    benchmark::DoNotOptimize(cut.nodes.data());
  }
  state.counters["nodes"] = static_cast<double>(cut.nodes.size());
}
BENCHMARK(cut_is_selected)->ArgName("km")->Arg(8)->Arg(32)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::visibility

BENCHMARK_MAIN();
