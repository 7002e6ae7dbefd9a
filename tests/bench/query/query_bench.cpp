// How long queries take, with all blocks cached (warm) and with none (cold). The argument is the
// world: 0 paper, 1 silver combe.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>

#include "engine/core/assert.hpp"
#include "engine/query/world.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::query {
namespace {

struct Loaded {
  models::Registry registry = models::make_standard_registry();
  world::World world;

  explicit Loaded(std::int64_t number) {
    const char* const name = number == 0 ? "paper.toml" : "silver_combe.toml";
    auto loaded = world::load_world(source_file("game/worlds/") + name, registry);
    PSYGEN_CHECK(loaded.has_value(), "the world is shipped");
    world = *loaded;
  }
};

constexpr std::int64_t kPlaces = 64;

core::WorldPosition place(World& query, std::int64_t i, double height_m) {
  core::WorldPosition at{{200, 200 + static_cast<std::int32_t>(i % 4)},
                         {std::fmod(static_cast<double>(i) * 17.3, 63), 0,
                          std::fmod(static_cast<double>(i) * 5.9, 63)}};
  at.local.y = query.ground(at)->height_m + height_m;
  return at;
}

void ground_under_a_point(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  World query(loaded.world, loaded.registry);
  core::WorldPosition at = place(query, 0, 0);
  for (auto _ : state) {
    at.local.x = at.local.x < 60 ? at.local.x + 0.37 : 1;
    benchmark::DoNotOptimize(query.ground(at));
  }
}
BENCHMARK(ground_under_a_point)->ArgName("world")->Arg(0)->Arg(1);

// Rays of 1 km in all directions from 60 m above the ground, along the mean slope of the land, so
// that most neither end soon nor leave the heights of the ground.
template <bool kModels>
void ray_over_a_kilometre(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  World query(loaded.world, loaded.registry, std::size_t{256} << 20);
  std::vector<Ray> rays;
  double followed_m = 0;
  for (std::int64_t i = 0; i < kPlaces; ++i) {
    const double turn = static_cast<double>(i) * 0.6;
    Ray ray{.origin = place(query, i, 60), .direction = {std::cos(turn), 0, std::sin(turn)}};
    ray.models = kModels;
    for (ray.direction.y = -0.2; ray.direction.y < 0.5; ray.direction.y += 0.005) {
      if (query.cast(ray)->kind == HitKind::kNothing) break;  // the lowest that clears the ground
    }
    rays.push_back(ray);
    followed_m += query.cast(ray)->distance_m / kPlaces;
  }
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(query.cast(rays[i++ % kPlaces]));
  state.counters["metres"] = followed_m;
}
BENCHMARK(ray_over_a_kilometre<false>)
    ->ArgName("world")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(ray_over_a_kilometre<true>)
    ->ArgName("world")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

void models_within_30_metres(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  World query(loaded.world, loaded.registry);
  std::vector<NearModel> found;
  double count = 0;
  std::vector<core::WorldPosition> places;
  for (std::int64_t i = 0; i < kPlaces; ++i)
    places.push_back(place(query, i, 1));
  std::size_t i = 0;
  for (auto _ : state) {
    (void)query.models_within(places[i++ % kPlaces], 30, found);
    count += static_cast<double>(found.size());
  }
  state.counters["models"] = count / static_cast<double>(state.iterations());
}
BENCHMARK(models_within_30_metres)->ArgName("world")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void nearest_tree(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  World query(loaded.world, loaded.registry);
  const models::ModelIndex only[] = {loaded.world.scatter[0].model};
  const core::WorldPosition at = place(query, 3, 1);
  for (auto _ : state)
    benchmark::DoNotOptimize(query.nearest(at, 200, only));
}
BENCHMARK(nearest_tree)->ArgName("world")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

// The first query of a block: ground, and then models, and then colliders.
enum class Part { kGround, kModels, kSolids };
template <Part kPart>
void first_touch(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  BlockCache cache(loaded.world, loaded.registry, 1);  // keeps one block
  std::int32_t x = 0;
  for (auto _ : state) {
    const core::BlockCoord block{++x % 500, 77};
    if (kPart == Part::kGround) benchmark::DoNotOptimize(cache.ground(block));
    if (kPart == Part::kModels) benchmark::DoNotOptimize(cache.models(block));
    if (kPart == Part::kSolids) benchmark::DoNotOptimize(cache.solids(block));
  }
}
BENCHMARK(first_touch<Part::kGround>)
    ->ArgName("world")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(first_touch<Part::kModels>)
    ->ArgName("world")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(first_touch<Part::kSolids>)
    ->ArgName("world")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::query

BENCHMARK_MAIN();
