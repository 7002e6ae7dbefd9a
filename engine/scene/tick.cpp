// The whole frame, in order. Each system is a free function; what it reads and writes is what its
// parameters in systems.hpp say. docs/architecture.md shows this list with it, and a test holds the
// two together.
#include "engine/scene/tick.hpp"

#include "engine/core/clock.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

void build_tick(State& s) {
  s.tick.provide(s.settings, s.facts, s.input, s.clock, s.camera, s.quality, s.daylight,
                 s.streaming, s.view, s.output, s.synthesis, s.draws, s.counters, s.totals, s.trace,
                 s.record);
  s.tick.add("input", input_system);
  s.tick.add("daylight", daylight_system);
  s.tick.add("streaming", streaming_system);
  s.tick.add("visibility", visibility_system);
  s.tick.add("cache", cache_system);
  s.tick.add("synthesis", synthesis_system);
  s.tick.add("upload", upload_system);
  s.tick.add("render", render_system, ecs::RunsOn::kCallingThread);
  s.tick.add("telemetry", telemetry_system);
}

namespace {

void trace_tick(const State& state) {
  telemetry::TraceLog& log = *state.trace.log;
  const auto systems = state.tick.systems();
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const double start_s = systems[i].last_start_s;
    log.add_span(state.trace.main, state.trace.systems[i], start_s,
                 start_s + systems[i].last_seconds, state.clock.tick);
  }
  const double now_s = core::monotonic_seconds();
  log.add_value(state.trace.cache_bytes, now_s, static_cast<double>(state.record.cache_bytes));
  log.add_value(state.trace.requests, now_s, state.record.requests_queued);
}

}  // namespace

void tick(State& state) {
  state.counters = {};
  state.output.error.reset();
  state.clock.real_s = state.clock.read_real_s();
  state.record = {};
  state.synthesis.manager->lower_priority();
  state.tick.run();
  const auto systems = state.tick.systems();
  for (std::size_t i = 0; i < systems.size(); ++i)
    state.record.system_ms[i] = static_cast<float>(systems[i].last_seconds * 1000.0);
  if (state.trace.log != nullptr) trace_tick(state);
  ++state.clock.tick;
}

}  // namespace psygen::scene
