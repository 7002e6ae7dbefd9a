// The whole frame, in order. Each system is a free function; its parameters say what it reads and
// writes. docs/architecture.md shows this list with them, and a test holds the two together.
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <string_view>

#include "engine/core/clock.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/scene/state.hpp"

namespace psygen::scene {
namespace {
constexpr std::string_view kRenderSystem = "render", kSimulationSystem = "simulation";
}  // namespace

void build_tick(State& s) {
  Events& events = s.events;
  s.tick.provide(s.settings, s.rules, s.facts, s.input, s.clock, s.camera, s.pressure, s.quality,
                 s.daylight, s.pending_edits, s.streaming, s.patches, s.view, s.output, s.supply,
                 s.meshes, s.draws, s.assets, s.object_draws, s.light_draws, s.particle_draws,
                 s.shown, s.simulation, s.step, s.trace, s.telemetry, events.shown, events.hidden,
                 events.created, events.removed, events.ready, events.evicted, events.places_ready,
                 events.world_changed, s.marks);
  s.tick.add(kSimulationSystem, simulation_system);
  s.tick.add("input", input_system);
  s.tick.add("quality", quality_system);
  s.tick.add("daylight", daylight_system);
  s.tick.add("edits", edits_system);
  s.tick.add("streaming", streaming_system);
  s.tick.add("visibility", visibility_system);
  s.tick.add("cache", cache_system);
  s.tick.add("synthesis", synthesis_system);
  s.tick.add("upload", upload_system);
  s.tick.add("objects", objects_system);
  s.tick.add("lights", lights_system);
  s.tick.add("particles", particles_system);
  s.tick.add(kRenderSystem, render_system, ecs::RunsOn::kCallingThread);
  s.tick.add("events", events_system);
  s.tick.add("telemetry", telemetry_system);
  for (const ecs::SystemInfo& system : s.tick.systems()) {
    s.engine_systems.insert(system.name);
    for (const ecs::Access& access : system.accesses)
      s.engine_values.insert(access.type);
  }
  s.simulation.systems.provide(s.facts, s.step, events.shown, events.hidden, events.created,
                               events.removed, events.ready, events.evicted, events.places_ready,
                               events.world_changed, s.marks);
}

void reset_counts(State& s) {
  s.streaming.counts = {};
  s.view.hidden = 0;
  s.meshes.counts = {};
  s.object_draws.counts = {};
  s.light_draws.counts = {};
  s.particle_draws.counts = {};
  s.draws.counts = {};
  s.draws.frame = {};
}

std::vector<std::string> system_names(const State& state) {
  std::vector<std::string> names;
  for (const ecs::SystemInfo& system : state.tick.systems())
    names.push_back(system.name);
  for (const ecs::SystemInfo& system : state.simulation.systems.systems())
    names.push_back("step " + system.name);
  return names;
}

namespace {

// Adds the renderer's waits, and the device time of the latest frame whose time is known.
void trace_frame(const render::FrameResult& frame, Tracing& trace) {
  const auto add = [&](telemetry::TraceLog::Name name, const render::Wait& wait) {
    if (wait.ms > 0)
      trace.log->add_span(trace.main, name, wait.start_s, wait.start_s + wait.ms * 1e-3,
                          frame.frame);
  };
  add(trace.device_wait, frame.device);
  add(trace.acquire, frame.acquire);
  add(trace.present, frame.present);
  if (!frame.gpu || frame.gpu->frame == trace.gpu_frame) return;
  trace.gpu_frame = frame.gpu->frame;
  trace.log->add_value(trace.gpu_ms, frame.gpu->submitted_s, frame.gpu->ms);
}

void trace_tick(State& state) {
  telemetry::TraceLog& log = *state.trace.log;
  trace_systems(state.tick.systems(), state.clock.tick, &Tracing::systems, state.trace);
  trace_frame(state.draws.frame, state.trace);
  const double now_s = core::monotonic_seconds();
  log.add_value(state.trace.cache_bytes, now_s,
                static_cast<double>(state.telemetry.record.cache_bytes));
  log.add_value(state.trace.requests, now_s, state.telemetry.record.requests_queued);
}

// Measures the systems without waits for the device and the display. The time of "simulation"
// excludes its systems, which have their own times.
void measure_systems(State& state) {
  const std::vector<float>& step_ms = state.simulation.step_ms;
  state.system_ms.clear();
  for (const ecs::SystemInfo& system : state.tick.systems()) {
    double elsewhere_ms = system.name == kRenderSystem ? state.telemetry.record.wait_ms() : 0.0;
    if (system.name == kSimulationSystem)
      elsewhere_ms = std::accumulate(step_ms.begin(), step_ms.end(), 0.0);
    const double ms = system.last_seconds * 1000.0 - elsewhere_ms;
    state.system_ms.push_back(static_cast<float>(std::max(ms, 0.0)));
  }
  state.system_ms.insert(state.system_ms.end(), step_ms.begin(), step_ms.end());
}

// Gathers the counted work of the systems. That of "simulation" excludes its systems.
void gather_work(State& state) {
  const std::vector<std::uint64_t>& step_work = state.simulation.step_work;
  const auto steps = std::accumulate(step_work.begin(), step_work.end(), std::uint64_t{0});
  state.system_work.clear();
  for (const ecs::SystemInfo& system : state.tick.systems()) {
    const std::uint64_t elsewhere = system.name == kSimulationSystem ? steps : 0;
    state.system_work.push_back(system.last_work - std::min(elsewhere, system.last_work));
  }
  state.system_work.insert(state.system_work.end(), step_work.begin(), step_work.end());
}

// Runs all systems. An exception of a system becomes an error that names it.
void run_systems(State& state) {
  const auto fail = [&state](core::ErrorCode code, const auto& describe) {
    const std::string& outer = state.tick.threw();
    const std::string& step = state.simulation.systems.threw();
    const std::string& system = outer == kSimulationSystem && !step.empty() ? step : outer;
    state.output.error = core::Error{code, describe(fmt::format("the system '{}'", system))};
  };
  const auto threw = [&fail](std::string_view what) {
    fail(core::ErrorCode::kInternal,
         [what](const std::string& system) { return fmt::format("{} threw: {}", system, what); });
  };
  try {
    state.tick.run();
  } catch (const std::bad_alloc&) {
    fail(core::ErrorCode::kOutOfMemory,
         [](const std::string& system) { return core::out_of_memory(system); });
  } catch (const std::exception& error) {
    threw(error.what());
  } catch (...) {
    threw("an exception of an unknown type");
  }
}

}  // namespace

void tick(State& state) {
  reset_counts(state);
  state.output.error.reset();
  state.clock.real_s = state.clock.read_real_s();
  state.telemetry.record = {};
  state.rules = rules_of(state.settings, false);
  if (state.settings.modelers_yield) state.supply.lower_priority();
  run_systems(state);
  measure_systems(state);
  if (state.counts_work) gather_work(state);
  if (state.trace.log != nullptr) trace_tick(state);
  ++state.clock.tick;
}

}  // namespace psygen::scene
