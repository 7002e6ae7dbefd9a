// Time of the merged mesh of all models of a node, by world and node level, with tree impostors,
// of all impostors of a world, and of the places of the models of a block.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/tree_impostors.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/bench/synthesis/per_target.hpp"
#include "tests/source_file.hpp"

namespace psygen::world {
namespace {

constexpr const char* kFiles[] = {"paper", "five_species", "silver_combe"};

// Consecutive nodes of one level. Arguments: world, node level, LOD.
void vegetation(benchmark::State& state) {
  models::Registry registry = models::make_standard_registry();
  const std::string file = source_file("game/worlds/") + kFiles[state.range(0)] + ".toml";
  auto loaded = load_world(file, registry);
  if (!loaded) return state.SkipWithError(loaded.error().message.c_str());
  const auto world = std::make_shared<const World>(*std::move(loaded));
  const auto type =
      make_merged_type(world, registry, std::make_shared<const ImpostorSet>(*world, registry));
  const int level = static_cast<int>(state.range(1));
  const int detail = static_cast<int>(state.range(2));
  const models::MeshSize size = type->mesh_size(merged_parameters({0, 0}, level), detail);
  std::vector<std::byte> vertices(size.vertex_count * sizeof(core::ModelVertex));
  std::vector<std::uint16_t> indices(size.index_count);
  std::int32_t node = 0;
  for (auto _ : state) {
    const models::Parameters p = merged_parameters({node & 7, node >> 3 & 7}, level);
    benchmark::DoNotOptimize(type->synthesise(p, detail, {vertices, indices}));
    ++node;
  }
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["vertices"] = size.vertex_count;
  state.counters["triangles"] = size.triangle_count();
  state.counters["complexity"] = type->complexity(merged_parameters({0, 0}, level), detail);
  models::bench::report_triangles(
      state, static_cast<double>(size.triangle_count()) * static_cast<double>(state.iterations()));
  models::bench::report_seconds_each(state, 1);
}
BENCHMARK(vegetation)
    ->ArgsProduct({{0, 1, 2}, {1, 2, 3, 4, 5}, {0, 1}})
    ->ArgNames({"world", "level", "detail"})
    ->Unit(benchmark::kMicrosecond);

// Arguments: world; 1 to bake the placeholders too. An iteration bakes all impostors.
void pictures(benchmark::State& state) {
  models::Registry registry = models::make_standard_registry();
  const std::string file = source_file("game/worlds/") + kFiles[state.range(0)] + ".toml";
  const auto world = load_world(file, registry);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  const ImpostorSet set(*world, registry);
  for (auto _ : state) {
    for (std::size_t i = 0; i < set.count(); ++i)
      benchmark::DoNotOptimize(state.range(1) == 0 ? set.bake(i) : set.stand_in(i));
  }
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["pictures"] = static_cast<double>(set.count());
  state.counters["MiB"] = static_cast<double>(set.count() * core::impostor_bytes()) / (1 << 20);
}
BENCHMARK(pictures)
    ->ArgsProduct({{0, 1, 2}, {0, 1}})
    ->ArgNames({"world", "stand-ins"})
    ->Unit(benchmark::kMillisecond);

// Every third block of a square, by land and sea, with the block's ground.
void places(benchmark::State& state, const char* name) {
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world(source_file("game/worlds/") + name + ".toml", registry);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  std::vector<Placement> placements;
  std::int32_t block = 0;
  for (auto _ : state) {
    place_models(*world, registry, {block % 24 * 3 - 160, block / 24 % 24 * 3 + 130}, placements);
    benchmark::DoNotOptimize(placements.data());
    ++block;
  }
}
BENCHMARK_CAPTURE(places, silver_combe, "silver_combe")
    ->Unit(benchmark::kMicrosecond)
    ->Iterations(1152);
BENCHMARK_CAPTURE(places, watershed, "watershed")->Unit(benchmark::kMicrosecond)->Iterations(1152);

// The paper's models with a spacing, a foot and three limits, and without; heights are kept apart.
void rules(benchmark::State& state, const char* of_scatters) {
  const models::Registry registry = models::make_standard_registry();
  std::string text = "format = 1\n[world]\nname = \"rules\"\nseed = 11\nblocks = [0, 0]\n";
  for (const char* model : {"\"tree\"\ncount = 23\n", "\"rock\"\ncount = 40\n"})
    text += std::string("[[scatter]]\nmodel = ") + model + of_scatters;
  const auto world = parse_world(text, "rules.toml", registry);
  if (!world) return state.SkipWithError(world.error().message.c_str());
  std::vector<models::BlockGround> grounds;
  for (std::int32_t x = 0; x < 256; ++x)
    grounds.emplace_back(world->terrain, core::BlockCoord{x, 7}, 10'000);
  std::vector<Placement> placements;
  std::int32_t x = 0;
  for (auto _ : state) {
    place_models(*world, registry, {x, 7}, grounds[static_cast<std::size_t>(x)], placements);
    benchmark::DoNotOptimize(placements.data());
    x = (x + 1) % 256;
  }
}
BENCHMARK_CAPTURE(rules, none, "")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(rules, spacing, "spacing_m = 3\n")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(rules, five,
                  "spacing_m = 3\nfootprint_m = 2\nmin_height_m = 5\nmax_height_m = 110\n"
                  "max_slope_deg = 40\n")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::world
