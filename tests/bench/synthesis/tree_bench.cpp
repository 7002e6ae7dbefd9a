// Time of trees at each level of detail on every instruction set, averaged over the paper's ranges
// (3 to 5 iterations, 2 to 4 branches), of the query of their size, and of the plain
// double-precision reference in the same run for scale.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/tree/tree.hpp"
#include "tests/bench/synthesis/per_target.hpp"
#include "tests/engine/models/oracle/tree.hpp"

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

void report(benchmark::State& state, double triangles) {
  state.counters["triangles_per_tree"] = triangles / kTrees;
  bench::report_triangles(state, triangles * static_cast<double>(state.iterations()));
  bench::report_seconds_each(state, kTrees);
}

void tree(benchmark::State& state) {
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
  std::vector<std::uint16_t> indices(3 * 131072);
  for (auto _ : state) {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const std::size_t bytes = sizes[i].vertex_count * sizeof(core::ModelVertex);
      benchmark::DoNotOptimize(type->synthesise(
          parameters[i], level,
          {std::span(vertices).first(bytes), std::span(indices).first(sizes[i].index_count)}));
    }
  }
  report(state, triangles);
}
// LOD 0 on every instruction set, the other LODs on the best set.
const bool kRegistered = bench::for_each_target("tree", tree, [](auto* b, bool best) {
  b->DenseRange(0, best ? 5 : 0)->ArgName("level")->Unit(benchmark::kMicrosecond);
});

void tree_reference(benchmark::State& state) {
  const auto type = make_tree_type();
  double triangles = 0;
  for (const Parameters& p : trees(*type))
    triangles += type->mesh_size(p, 0).triangle_count();
  for (auto _ : state)
    for (const Parameters& p : trees(*type)) {
      const TreePlan plan = plan_of_tree(p);
      benchmark::DoNotOptimize(test::TreeOracle(plan).mesh(0));
    }
  report(state, triangles);
}
BENCHMARK(tree_reference)
    ->Name("tree/reference")
    ->Arg(0)
    ->ArgName("level")
    ->Unit(benchmark::kMicrosecond);

// Hashes integers only.
void tree_size(benchmark::State& state) {
  const auto type = make_tree_type();
  const std::vector<Parameters> parameters = trees(*type);
  for (auto _ : state)
    for (const Parameters& p : parameters)
      benchmark::DoNotOptimize(type->mesh_size(p, static_cast<int>(state.range(0))));
  bench::report_seconds_each(state, kTrees);
}
const bool kSizesRegistered = bench::for_each_target(
    "tree_size", tree_size,
    [](auto* b, bool best) { b->DenseRange(0, best ? 5 : 0)->ArgName("level"); });

}  // namespace
}  // namespace psygen::models
