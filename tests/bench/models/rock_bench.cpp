// Time of a rock per number of subdivisions on every instruction set of this CPU; the plain
// double-precision reference in the same run, of places and triangles only, is the scale.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/rock.hpp"
#include "tests/bench/models/per_target.hpp"
#include "tests/engine/models/oracle_rock.hpp"

namespace psygen::models {
namespace {

void synthesize_rocks(benchmark::State& state, RockFamily family, std::int64_t subdivisions) {
  const bench::PinnedTarget target(state);
  const auto type = make_rock_type();
  Parameters p = default_parameters(*type);
  p.set_integer(kRockFamily, family);
  p.set_integer(kRockSubdivisions, subdivisions);
  const MeshSize size = type->mesh_size(p, 0);
  std::vector<std::byte> vertices(size.vertex_count * sizeof(core::ModelVertex));
  std::int64_t seed = 0;
  for (auto _ : state) {
    p.set_integer(kRockSeed, seed++);
    benchmark::DoNotOptimize(type->synthesize(p, 0, {vertices, {}}));
  }
  state.counters["triangles_per_second"] = benchmark::Counter(
      size.triangle_count() * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void rock(benchmark::State& state) {
  synthesize_rocks(state, kRockRounded, state.range(1));
}
BENCHMARK(rock)->Apply([](auto* b) { bench::each_target_with(b, "subdivisions", 0, 6, 2); });

void rock_faceted(benchmark::State& state) {
  synthesize_rocks(state, kRockFaceted, 2);
}
BENCHMARK(rock_faceted)->Apply(bench::each_target);

void rock_layered(benchmark::State& state) {
  synthesize_rocks(state, kRockLayered, 2);
}
BENCHMARK(rock_layered)->Apply(bench::each_target);

void rock_reference(benchmark::State& state) {
  std::uint64_t seed = 0;
  double triangles = 0;
  for (auto _ : state) {
    test::RockOracle oracle{.seed = seed++, .subdivisions = static_cast<int>(state.range(0))};
    oracle.build();
    triangles += static_cast<double>(oracle.triangles.size());
    benchmark::DoNotOptimize(oracle.places.data());
  }
  state.counters["triangles_per_second"] =
      benchmark::Counter(triangles, benchmark::Counter::kIsRate);
}
BENCHMARK(rock_reference)->Arg(2)->ArgName("subdivisions");

}  // namespace
}  // namespace psygen::models
