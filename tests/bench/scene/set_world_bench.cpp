// Time for a scene to switch to another world at every step of a slider: in total, on the main
// thread (during which no frame is drawn), and on the modelers for new meshes at full detail and as
// a draft.
#include <benchmark/benchmark.h>

#include <fstream>
#include <iterator>

#include "engine/core/log.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/state.hpp"
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

std::string text_of_world() {
  std::ifstream in(source_file("game/worlds/silver_combe.toml"));
  return {std::istreambuf_iterator<char>(in), {}};
}

core::CameraPose usual_pose() {
  core::CameraPose pose;
  pose.position = {{-20, 63}, {3.0, 60.0, 9.0}};
  pose.yaw = 1.9;
  return pose;
}

// Changes a value of a shipped world back and forth, with a full view.
enum class Part { kAll, kMainThread };
void set_world(benchmark::State& state, Part part, const world::TextPath& path, const char* low,
               const char* high) {
  const std::string text = text_of_world();
  const std::string texts[] = {world::with_value(text, path, low).value(),
                               world::with_value(text, path, high).value()};
  Parsed first(texts[0]);
  SceneSettings settings;
  settings.modelers = 1;
  auto scene = Scene::create(first.world, std::move(first.registry), settings, nullptr).value();
  const core::CameraPose pose = usual_pose();
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

// Processor seconds of the modelers until all new meshes of the view are ready.
void make_meshes(benchmark::State& state, bool draft, const world::TextPath& path, const char* low,
                 const char* high) {
  const std::string text = text_of_world();
  const std::string texts[] = {world::with_value(text, path, low).value(),
                               world::with_value(text, path, high).value()};
  const core::CameraPose pose = usual_pose();
  for (auto _ : state) {
    Parsed first(texts[0]), second(texts[1]);
    SceneSettings settings;
    settings.modelers = 1;
    settings.main_thread_budget_ms = 0;
    auto scene = Scene::create(first.world, std::move(first.registry), settings, nullptr).value();
    scene->settle(pose);
    const double before_s = state_of(*scene).supply.modeler_stats().cpu_seconds;
    benchmark::DoNotOptimize(scene->set_world(std::move(second.world), std::move(second.registry)));
    state_of(*scene).input.pose = pose;
    state_of(*scene).input.draft = draft;
    for (int quiet = 0; quiet < 16;) {
      tick(state_of(*scene));
      state_of(*scene).supply.wait();
      quiet = scene->statistics().meshes.requests == 0 ? quiet + 1 : 0;
    }
    state.SetIterationTime(state_of(*scene).supply.modeler_stats().cpu_seconds - before_s);
  }
}

void tree_meshes(benchmark::State& state, bool draft) {
  make_meshes(state, draft, {"scatter", 0, "size_m"}, "[2.2, 3.4]", "[2.2, 3.3]");
}
void ground_meshes(benchmark::State& state, bool draft) {
  make_meshes(state, draft, {"terrain", "height"}, "1.15", "1.1");
}
BENCHMARK_CAPTURE(tree_meshes, fine, false)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(tree_meshes, draft, true)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(ground_meshes, fine, false)->Unit(benchmark::kMillisecond)->UseManualTime();
BENCHMARK_CAPTURE(ground_meshes, draft, true)->Unit(benchmark::kMillisecond)->UseManualTime();

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
