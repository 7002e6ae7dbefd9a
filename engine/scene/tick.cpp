// The whole frame, in order. Each system is a free function over the parts that it names; what is
// const in its parameters it only reads. docs/architecture.md shows this list, and a test holds the
// two together.
#include "engine/scene/tick.hpp"

#include <array>

#include "engine/core/clock.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

constexpr std::array kTick{
    System{"input", "Input, Clock", "Camera",
           [](State& s) { input_system(s.input, s.clock, s.facts, s.camera); }},
    System{"streaming", "Camera, World", "Block, Placed, Detail, Source",
           [](State& s) {
             streaming_system(s.settings, s.camera, s.facts, s.streaming, s.entities,
                              *s.synthesis.cache, s.counters);
           }},
    System{"visibility", "Camera, World, Block", "View, Visibility",
           [](State& s) {
             visibility_system(s.settings, s.camera, s.facts, s.streaming, s.entities, s.view,
                               s.counters);
           }},
    System{"cache", "View, Visibility, Placed, Detail, Source", "Demand, plan",
           [](State& s) {
             cache_system(s.settings, s.clock, s.camera, s.facts, s.streaming, s.view, s.entities,
                          s.synthesis, s.counters, s.totals);
           }},
    System{"synthesis", "plan", "finished meshes",
           [](State& s) { synthesis_system(s.settings, s.synthesis, s.counters, s.trace); }},
    System{"upload", "finished meshes", "Mesh, Demand",
           [](State& s) {
             upload_system(s.settings, s.clock, s.facts, s.entities, s.synthesis, s.shared_indices,
                           s.renderer, s.counters, s.totals);
           }},
    System{"render", "Camera, View, Placed, Demand, Mesh", "draw lists, frame",
           [](State& s) {
             render_system(s.input, s.clock, s.camera, s.facts, s.streaming, s.view, s.entities,
                           s.draws, s.renderer, s.counters, s.error);
           }},
    System{
        "telemetry", "all counters", "frame log",
        [](State& s) { telemetry_system(s.clock, s.counters, s.synthesis, s.totals, s.record); }},
};

}  // namespace

std::span<const System> tick_systems() {
  return kTick;
}

void tick(State& state) {
  state.counters = {};
  state.error.reset();
  state.clock.real_s = core::monotonic_seconds() - state.clock.origin_s;
  state.record = {};
  for (std::size_t i = 0; i < kTick.size(); ++i) {
    const double start_s = core::monotonic_seconds();
    kTick[i].run(state);
    const double end_s = core::monotonic_seconds();
    state.record.system_ms[i] = static_cast<float>((end_s - start_s) * 1000.0);
    if (state.trace.log != nullptr) {
      state.trace.log->add_span(state.trace.main, state.trace.systems[i], start_s, end_s,
                                state.clock.tick);
    }
  }
  if (state.trace.log != nullptr) {
    const double now_s = core::monotonic_seconds();
    state.trace.log->add_value(state.trace.cache_bytes, now_s,
                               static_cast<double>(state.record.cache_bytes));
    state.trace.log->add_value(state.trace.requests, now_s, state.record.requests_queued);
  }
  ++state.clock.tick;
}

}  // namespace psygen::scene
