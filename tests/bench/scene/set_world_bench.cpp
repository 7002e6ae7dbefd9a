// How long a scene takes to take over another world while it is drawn: what an editor waits for at
// every step of a slider.
#include <benchmark/benchmark.h>

#include <fstream>
#include <iterator>

#include "engine/core/log.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

struct Parsed {
  models::Registry registry = models::make_standard_registry();
  world::World world;
  explicit Parsed(const std::string& text) {
    world = world::parse_world(text, "bench.toml", registry).value();
  }
};

// Steps a value of a shipped world back and forth, with all that its view holds.
void set_world(benchmark::State& state, const world::TextPath& path, const char* low,
               const char* high) {
  std::ifstream in(source_file("game/worlds/silver_combe.toml"));
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string texts[] = {world::with_value(text, path, low).value(),
                               world::with_value(text, path, high).value()};
  Parsed first(texts[0]);
  Settings settings;
  settings.modelers = 1;
  auto scene = Scene::create(first.world, std::move(first.registry), settings, nullptr).value();
  core::CameraPose pose;
  pose.position = {{-20, 63}, {3.0, 60.0, 9.0}};
  pose.yaw = 1.9;
  scene->settle(pose);
  std::size_t next = 1;
  for (auto _ : state) {
    Parsed parsed(texts[next++ % 2]);
    benchmark::DoNotOptimize(scene->set_world(std::move(parsed.world), std::move(parsed.registry)));
    state.PauseTiming();
    scene->settle(pose);
    state.ResumeTiming();
  }
}

void tree_size(benchmark::State& state) {
  set_world(state, {"scatter", 0, "size_m"}, "[2.2, 3.4]", "[2.2, 3.3]");
}
void sky(benchmark::State& state) {
  set_world(state, {"sky", "exposure"}, "1", "1.1");
}
void ground(benchmark::State& state) {
  set_world(state, {"terrain", "height"}, "1.15", "1.1");
}
BENCHMARK(tree_size)->Unit(benchmark::kMillisecond);
BENCHMARK(sky)->Unit(benchmark::kMillisecond);
BENCHMARK(ground)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace psygen::scene

BENCHMARK_MAIN();
