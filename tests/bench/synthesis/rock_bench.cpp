// Time of a rock per number of subdivisions on every instruction set of this CPU; the plain
// double-precision reference in the same run (positions and triangles only) gives the scale.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/rock/rock.hpp"
#include "tests/bench/synthesis/per_target.hpp"
#include "tests/engine/models/oracle/rock.hpp"

namespace psygen::models {
namespace {

void synthesise_rocks(benchmark::State& state, RockFamily family, std::int64_t subdivisions) {
  const auto type = make_rock_type();
  Parameters p = default_parameters(*type);
  p.set_integer(kRockFamily, family);
  p.set_integer(kRockSubdivisions, subdivisions);
  const MeshSize size = type->mesh_size(p, 0);
  std::vector<std::byte> vertices(size.vertex_count * sizeof(core::ModelVertex));
  std::int64_t seed = 0;
  for (auto _ : state) {
    p.set_integer(kRockSeed, seed++);
    benchmark::DoNotOptimize(type->synthesise(p, 0, {vertices, {}}));
  }
  bench::report_triangles(state, size.triangle_count() * static_cast<double>(state.iterations()));
  bench::report_seconds_each(state, 1);
}

void rock(benchmark::State& state) {
  synthesise_rocks(state, kRockRounded, state.range(0));
}
const bool kRegistered = bench::for_each_target(
    "rock", rock, [](auto* b, bool) { b->DenseRange(0, 6, 2)->ArgName("subdivisions"); });

void rock_faceted(benchmark::State& state) {
  synthesise_rocks(state, kRockFaceted, state.range(0));
}
const bool kFacetedRegistered = bench::for_each_target(
    "rock_faceted", rock_faceted, [](auto* b, bool) { b->Arg(2)->ArgName("subdivisions"); });

void rock_layered(benchmark::State& state) {
  synthesise_rocks(state, kRockLayered, state.range(0));
}
const bool kLayeredRegistered = bench::for_each_target(
    "rock_layered", rock_layered, [](auto* b, bool) { b->Arg(2)->ArgName("subdivisions"); });

void rock_reference(benchmark::State& state) {
  std::uint64_t seed = 0;
  double triangles = 0;
  for (auto _ : state) {
    test::RockOracle oracle{.seed = seed++, .subdivisions = static_cast<int>(state.range(0))};
    oracle.build();
    triangles += static_cast<double>(oracle.triangles.size());
    benchmark::DoNotOptimize(oracle.places.data());
  }
  bench::report_triangles(state, triangles);
  bench::report_seconds_each(state, 1);
}
BENCHMARK(rock_reference)->Name("rock/reference")->Arg(2)->ArgName("subdivisions");

}  // namespace
}  // namespace psygen::models
