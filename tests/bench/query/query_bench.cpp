// Time of queries with all blocks cached (warm) and with none (cold). The argument selects the
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

// Rays of 1 km in all directions from 60 m above the ground, along the mean slope, so that most
// rays neither end early nor leave the height range of the ground.
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
      if (query.cast(ray)->kind == HitKind::kNothing)
        break;  // the lowest ray that clears the ground
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
  std::vector<NearbyModel> found;
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

// 10,000 boxes within a kilometre, or (argument `crowded`) within a block, just above the ground.
struct Crowd {
  static constexpr int kCount = 10'000;
  Loaded loaded{0};
  World query{loaded.world, loaded.registry, std::size_t{256} << 20};
  Objects objects{loaded.world};
  std::vector<ObjectId> ids;
  std::vector<ObjectPose> poses;

  explicit Crowd(bool crowded) {
    models::Collider box;
    box.shapes.emplace_back(core::Bounds{glm::vec3(-0.5F), glm::vec3(0.5F)});
    const ObjectShape shape = *Objects::make_shape(box);
    const double side_m = crowded ? 64 : 1000;
    for (int i = 0; i < kCount; ++i) {
      ObjectPose pose{.position = {{200, 200},
                                   {std::fmod(i * 0.618034, 1.0) * side_m, 0,
                                    std::fmod(i * 0.754878, 1.0) * side_m}}};
      pose.position.local.y = query.ground(pose.position)->height_m + 1 + i % 3;
      poses.push_back(pose);
      ids.push_back(*objects.add(static_cast<ObjectTag>(i + 1), shape, pose));
    }
    query.meet(&objects);
  }
};

// Rays of 1 km past all boxes: against ground, models and objects, or objects alone.
void ray_among_objects(benchmark::State& state) {
  Crowd crowd(state.range(0) != 0);
  std::vector<Ray> rays;
  for (std::int64_t i = 0; i < kPlaces; ++i) {
    const double turn = static_cast<double>(i) * 0.6;
    Ray ray{.origin = {{200, 200}, {500 + 3.0 * static_cast<double>(i % 8), 0, 500}},
            .direction = {std::cos(turn), 0, std::sin(turn)}};
    if (state.range(0) != 0) ray.origin.local -= glm::dvec3(470, 0, 470);
    ray.origin.local.y = crowd.query.ground(ray.origin)->height_m + 30;
    ray.ground = ray.models = state.range(1) != 0;
    rays.push_back(ray);
  }
  std::size_t i = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(crowd.query.cast(rays[i++ % kPlaces]));
}
BENCHMARK(ray_among_objects)
    ->ArgNames({"crowded", "all"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

// A step in which all boxes move at 6 m/s and turn, or none.
void objects_move(benchmark::State& state) {
  Crowd crowd(false);
  double way_m = state.range(0) != 0 ? 0.1 : 0;
  int steps = 0;
  for (auto _ : state) {
    if (++steps % 600 == 0) way_m = -way_m;
    for (std::size_t i = 0; i < crowd.ids.size(); ++i) {
      ObjectPose& pose = crowd.poses[i];
      pose.position.local += glm::dvec3(way_m, 0, i % 2 == 0 ? way_m : -way_m);
      if (way_m != 0) pose.rotation.y += 0.01;
      benchmark::DoNotOptimize(crowd.objects.move(crowd.ids[i], pose));
    }
    crowd.objects.remove_stale();
  }
}
BENCHMARK(objects_move)->ArgName("moving")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// By address, because Google Benchmark 1.8 deprecates references to constants.
void consume(const auto& value) {
  const void* address = &value;
  benchmark::DoNotOptimize(address);
}

// The first query of a block: ground, then models, then colliders.
enum class Part { kGround, kModels, kSolids };
template <Part kPart>
void first_touch(benchmark::State& state) {
  const Loaded loaded(state.range(0));
  BlockCache cache(loaded.world, loaded.registry, 1);  // keeps one block
  std::int32_t x = 0;
  for (auto _ : state) {
    const core::BlockCoord block{++x % 500, 77};
    if (kPart == Part::kGround) consume(cache.ground(block));
    if (kPart == Part::kModels) consume(cache.models(block));
    if (kPart == Part::kSolids) consume(cache.solids(block));
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
