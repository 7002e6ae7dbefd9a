// Cost of visibility: PLP over about 100,000 blocks, bounds against frustum and horizon, the
// quadtree cut, and the choice of LODs. Run with --benchmark_repetitions=9 and read the medians.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/visibility/horizon.hpp"
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
  constexpr int kCount = 4096;
  constexpr std::array kErrors{0.0F, 0.1F, 0.3F, 0.9F, 2.7F};
  for (auto _ : state) {
    for (int i = 0; i < kCount; ++i)
      benchmark::DoNotOptimize(choose_level(kErrors, static_cast<float>(i), 745, 2, -1));
  }
  state.SetItemsProcessed(state.iterations() * kCount);
}
BENCHMARK(levels_are_chosen);

// A camera over an endless world, with roots up to the view distance.
struct QuadtreeScene {
  std::vector<LevelDistances> levels = std::vector<LevelDistances>(8);
  std::vector<NodeCoord> roots;
  CutInput input;

  QuadtreeScene(double view_m, double max_error_pixels) {
    std::vector<double> errors;
    for (double error = 0.2; errors.size() < levels.size(); error *= 2)
      errors.push_back(error);
    split_distances(errors, {.pixels_per_radian = 745, .max_error_pixels = max_error_pixels},
                    levels);
    input.camera = {{1000, -2000}, {20, 30, 40}};
    input.levels = levels;
    input.view_distance_m = view_m;
    roots_around(input.camera, input.block_size_m, view_m, 7, roots);
    input.roots = roots;
  }
};

void cut_is_selected(benchmark::State& state) {
  const QuadtreeScene scene(static_cast<double>(state.range(0)) * 1000, 1);
  Cut cut;
  for (auto _ : state) {
    select_cut(scene.input, cut);
    benchmark::DoNotOptimize(cut.nodes.data());
  }
  state.counters["nodes"] = static_cast<double>(cut.nodes.size());
}
BENCHMARK(cut_is_selected)->ArgName("km")->Arg(8)->Arg(32)->Unit(benchmark::kMicrosecond);

// Hilly ground relative to a camera that stands on one of the slopes.
float hills(float x, float z) {
  return 60 * std::sin(x * 0.004F) * std::cos(z * 0.005F) + 15 * std::sin(x * 0.021F + z * 0.017F) -
         20;
}

// The leaves of a cut, from front to back: their boxes and for each a line across, 22 points long.
struct Leaves {
  std::vector<core::Bounds> boxes;
  std::vector<std::vector<glm::vec3>> lines;

  explicit Leaves(const Cut& cut) {
    for (const CutNode& node : cut.nodes) {
      if (!node.leaf) continue;
      std::vector<glm::vec3> line;
      core::Bounds box = node.box(1e9F, -1e9F);
      // Perpendicular to the view direction, at the resolution of a height grid.
      const bool along_x = std::abs(box.centre().z) > std::abs(box.centre().x);
      for (int k = 0; k < 22; ++k) {
        const float f = static_cast<float>(k) / 21;
        glm::vec3 p = box.centre();
        (along_x ? p.x : p.z) =
            along_x ? std::lerp(box.min.x, box.max.x, f) : std::lerp(box.min.z, box.max.z, f);
        p.y = hills(p.x, p.z);
        line.push_back(p);
        for (int j = 0; j < 22; ++j) {
          glm::vec3 q = p;
          (along_x ? q.z : q.x) = along_x
                                      ? std::lerp(box.min.z, box.max.z, static_cast<float>(j) / 21)
                                      : std::lerp(box.min.x, box.max.x, static_cast<float>(j) / 21);
          box.min.y = std::min(box.min.y, hills(q.x, q.z));
          box.max.y = std::max(box.max.y, hills(q.x, q.z));
        }
      }
      boxes.push_back(box);
      lines.push_back(line);
    }
  }
};

// Tests all 2,000 bounds; the nearest `lines` visible leaves add an occluder line.
void horizon_is_built_and_asked(benchmark::State& state) {
  const QuadtreeScene scene(8000, 0.25);
  Cut cut;
  select_cut(scene.input, cut);
  const Leaves leaves(cut);
  const std::size_t count = std::min<std::size_t>(leaves.boxes.size(), 2000),
                    lines = std::min<std::size_t>(static_cast<std::size_t>(state.range(0)), count);
  Horizon horizon;
  std::size_t hidden = 0, added = 0;
  for (auto _ : state) {
    horizon.reset();
    hidden = added = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (horizon.hides(leaves.boxes[i])) {
        ++hidden;
      } else if (added < lines) {
        ++added;
        horizon.add(leaves.lines[i]);
      }
    }
    benchmark::DoNotOptimize(hidden);
  }
  state.counters["boxes"] = static_cast<double>(count);
  state.counters["lines"] = static_cast<double>(added);
  state.counters["hidden"] = static_cast<double>(hidden);
}
BENCHMARK(horizon_is_built_and_asked)
    ->ArgName("lines")
    ->Arg(0)
    ->Arg(200)
    ->Arg(2000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::visibility

BENCHMARK_MAIN();
