// How long a scene takes to take over another world while it is drawn, at every step of a slider:
// in all, and of that the part of the main thread, while which nothing is drawn.
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
enum class Part { kAll, kMainThread };
void set_world(benchmark::State& state, Part part, const world::TextPath& path, const char* low,
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
    if (part == Part::kMainThread) state.PauseTiming();
    Parsed parsed(texts[next++ % 2]);
    auto prepared =
        prepare_world(std::move(parsed.world), std::move(parsed.registry), scene->snapshot());
    if (part == Part::kMainThread) state.ResumeTiming();
    benchmark::DoNotOptimize(scene->set_world(std::move(prepared.value())));
    state.PauseTiming();
    scene->settle(pose);
    state.ResumeTiming();
  }
}

void trees(benchmark::State& state, Part part) {
  set_world(state, part, {"scatter", 0, "size_m"}, "[2.2, 3.4]", "[2.2, 3.3]");
}
void sky(benchmark::State& state, Part part) {
  set_world(state, part, {"sky", "exposure"}, "1", "1.1");
}
void ground(benchmark::State& state, Part part) {
  set_world(state, part, {"terrain", "height"}, "1.15", "1.1");
}
BENCHMARK_CAPTURE(trees, all, Part::kAll)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trees, main_thread, Part::kMainThread)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ground, all, Part::kAll)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ground, main_thread, Part::kMainThread)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sky, all, Part::kAll)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace psygen::scene

BENCHMARK_MAIN();
