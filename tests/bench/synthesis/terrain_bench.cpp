// Time of a terrain block per level, of its heights alone, and of ground queries, on every
// instruction set of this CPU; the plain double-precision reference in the same run gives the
// scale.
#include <benchmark/benchmark.h>

#include <array>
#include <numeric>
#include <vector>

#include "engine/models/terrain/light.hpp"
#include "engine/models/terrain/ridged_noise.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/bench/synthesis/per_target.hpp"
#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models {
namespace {

void noise_65x65(benchmark::State& state, double warp) {
  const RidgedNoise noise(
      {.seed = 1, .height = 1.2, .offset = 0.88, .cells_per_step = 1.0 / 600, .warp = warp});
  std::array<std::int64_t, 65> columns, rows;
  std::vector<float> values(65 * 65);
  std::int64_t block = 0;
  for (auto _ : state) {
    std::iota(columns.begin(), columns.end(), 63 * block++);
    std::iota(rows.begin(), rows.end(), 17 * block);
    noise.evaluate(columns, rows, values, 65);
    benchmark::DoNotOptimize(values.data());
  }
  bench::report_seconds_each(state, 65 * 65);
}

void noise_65x65_reference(benchmark::State& state) {
  const test::TerrainOracle oracle{
      .seed = 1, .height = 1.2, .offset = 0.88, .cells_per_step = 1.0 / 600};
  std::int64_t block = 0;
  for (auto _ : state) {
    double sum = 0;
    for (std::int64_t z = 0; z < 65; ++z) {
      for (std::int64_t x = 0; x < 65; ++x)
        sum += oracle.value(63 * block + x, z);
    }
    ++block;
    benchmark::DoNotOptimize(sum);
  }
  bench::report_seconds_each(state, 65 * 65);
}
BENCHMARK(noise_65x65_reference)->Name("terrain_noise_65x65/reference");

// Shadows and horizons of a block alone. The argument is the sun's elevation in degrees.
void terrain_light(benchmark::State& state) {
  const Parameters p = default_parameters(*make_terrain_type());
  const TerrainShape shape(p);
  std::int64_t block = 0;
  for (auto _ : state) {
    const TerrainLight light(shape, {128, static_cast<double>(state.range(0))}, block++, 7, 0);
    benchmark::DoNotOptimize(light.samples().sun);
  }
  bench::report_seconds_each(state, 1);
}

// Heights and vertices of LOD 0 as in terrain_block, fully lit. Samples are aligned as in
// TerrainType, vertices as in BlockSynthesiser: to a cache line.
void terrain_block_unlit(benchmark::State& state) {
  const TerrainShape shape(default_parameters(*make_terrain_type()));
  constexpr std::size_t kSide = 66, kStride = 80;
  const std::vector<float> light(23 * 64 + 32, 255.0F);
  alignas(64) std::array<float, kSide * kStride + 16> noise;
  alignas(64) std::array<std::byte, (64 * 64 + 4 * 63) * sizeof(core::TerrainVertex)> vertices;
  std::array<std::int64_t, kSide> columns, rows;
  std::iota(rows.begin(), rows.end(), -1);
  std::int64_t block = 0;
  for (auto _ : state) {
    std::iota(columns.begin(), columns.end(), 63 * block++ - 1);
    shape.noise.evaluate(columns, rows, noise, kStride);
    const float* const first = &noise[kStride + 1];
    const TerrainSurface surface{.first = first,
                                 .row_stride = kStride,
                                 .step = 1,
                                 .n = 64,
                                 .stride = 1,
                                 .coarse = {first, kStride, 3, 3, 0, 0},
                                 .light = {light.data(), light.data(), 64, 3, 0, 0},
                                 .quantum = shape.quantum,
                                 .slope_scale = shape.metres / 2};
    benchmark::DoNotOptimize(pack_terrain(surface, vertices.data()));
  }
  bench::report_seconds_each(state, 1);
}

void terrain_block(benchmark::State& state) {
  const auto type = make_terrain_type();
  const int level = static_cast<int>(state.range(0));
  Parameters p = default_parameters(*type);
  p.set_real(kTerrainSunAzimuth, 128);
  p.set_real(kTerrainSunElevation, static_cast<double>(state.range(1)));
  const MeshSize size = type->mesh_size(p, level);
  std::vector<std::byte> vertices(size.vertex_count * sizeof(core::TerrainVertex));
  std::int64_t block = 0;
  for (auto _ : state) {
    p.set_integer(kTerrainBlockX, block++);
    benchmark::DoNotOptimize(type->synthesise(p, level, {vertices, {}}));
  }
  bench::report_seconds_each(state, 1);
}

// Base points of 63 models.
void terrain_ground_63_points(benchmark::State& state) {
  const Parameters p = default_parameters(*make_terrain_type());
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 63; ++i)
    points.push_back({i + 0.3, 62.6 - i});
  std::vector<GroundPoint> ground(points.size());
  std::int32_t block = 0;
  for (auto _ : state) {
    sample_ground(p, {block++, 0}, points, ground);
    benchmark::DoNotOptimize(ground.data());
  }
  bench::report_seconds_each(state, 1);
}

const bool kRegistered =
    bench::for_each_target("terrain_noise_65x65", [](auto& state) { noise_65x65(state, 0); }) &&
    bench::for_each_target("terrain_noise_warped_65x65",
                           [](auto& state) { noise_65x65(state, 0.3); }) &&
    bench::for_each_target("terrain_block", terrain_block,
                           [](auto* b, bool) {
                             b->ArgNames({"level", "sun"})->ArgsProduct({{0, 1, 2, 3}, {90, 30}});
                           }) &&
    bench::for_each_target("terrain_block_unlit", terrain_block_unlit) &&
    bench::for_each_target("terrain_light", terrain_light,
                           [](auto* b, bool) { b->ArgName("sun")->Arg(90)->Arg(30)->Arg(8); }) &&
    bench::for_each_target("terrain_ground_63_points", terrain_ground_63_points);

}  // namespace
}  // namespace psygen::models
