// Time of a rock per number of subdivisions.
#include <benchmark/benchmark.h>

#include <vector>

#include "engine/models/rock.hpp"

namespace psygen::models {
namespace {

void rock(benchmark::State& state) {
  const auto type = make_rock_type();
  Parameters p = default_parameters(*type);
  p.set_integer(kRockSubdivisions, state.range(0));
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
BENCHMARK(rock)->DenseRange(0, 6, 2)->ArgName("subdivisions");

}  // namespace
}  // namespace psygen::models
