// Time of trees at each level of detail, averaged over the paper's ranges (3 to 5 iterations, 2 to
// 4 branches), and of the question for their size.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/tree.hpp"

namespace psygen::models {
namespace {

constexpr int kTrees = 90;

std::vector<Parameters> trees(const ModelType& type) {
  std::vector<Parameters> result;
  for (int i = 0; i < kTrees; ++i) {
    result.push_back(default_parameters(type));
    result.back().set_integer(kTreeSeed, 1000 + i);
    result.back().set_integer(kTreeIterations, 3 + i % 3);
    result.back().set_integer(kTreeBranches, 2 + i / 3 % 3);
  }
  return result;
}

void tree_synthesis(benchmark::State& state) {
  const auto type = make_tree_type();
  const int level = static_cast<int>(state.range(0));
  const std::vector<Parameters> parameters = trees(*type);
  std::vector<MeshSize> sizes;
  double triangles = 0;
  for (const Parameters& p : parameters) {
    sizes.push_back(type->mesh_size(p, level));
    triangles += sizes.back().triangle_count();
  }
  std::vector<std::byte> vertices(65536 * sizeof(core::ModelVertex));
  std::vector<std::uint16_t> indices(3 * 65536);
  for (auto _ : state) {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const std::size_t bytes = sizes[i].vertex_count * sizeof(core::ModelVertex);
      benchmark::DoNotOptimize(type->synthesize(
          parameters[i], level,
          {std::span(vertices).first(bytes), std::span(indices).first(sizes[i].index_count)}));
    }
  }
  const double done = static_cast<double>(state.iterations());
  state.counters["triangles_per_tree"] = triangles / kTrees;
  state.counters["triangles_per_second"] =
      benchmark::Counter(triangles * done, benchmark::Counter::kIsRate);
  state.counters["seconds_per_tree"] =
      benchmark::Counter(kTrees * done, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(tree_synthesis)->DenseRange(0, 5)->ArgName("level")->Unit(benchmark::kMicrosecond);

void tree_size(benchmark::State& state) {
  const auto type = make_tree_type();
  const std::vector<Parameters> parameters = trees(*type);
  for (auto _ : state)
    for (const Parameters& p : parameters)
      benchmark::DoNotOptimize(type->mesh_size(p, static_cast<int>(state.range(0))));
  state.counters["seconds_per_tree"] =
      benchmark::Counter(kTrees * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(tree_size)->DenseRange(0, 5)->ArgName("level");

}  // namespace
}  // namespace psygen::models
