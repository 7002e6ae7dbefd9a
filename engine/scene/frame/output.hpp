// The outputs of a scene: its renderer, the error that ended the flight, and its trace. Values;
// main thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/telemetry/trace_log.hpp"

namespace psygen::ecs {
struct SystemInfo;
}
namespace psygen::models {
class Registry;
}
namespace psygen::render {
class Renderer;
}

namespace psygen::scene {

struct Output {
  render::Renderer* renderer = nullptr;  // null: everything runs except drawing
  std::optional<core::Error> error;
};

// The trace of a run, with names that are looked up once.
struct Tracing {
  telemetry::TraceLog* log = nullptr;  // null: no trace
  telemetry::TraceLog::Track main = 0, cache_bytes = 0, requests = 0, gpu_ms = 0;
  std::uint64_t gpu_frame = 0;                                          // the last one in gpu_ms
  std::vector<telemetry::TraceLog::Name> systems;                       // in the order of the tick
  std::vector<telemetry::TraceLog::Name> steps;                         // of the simulation
  telemetry::TraceLog::Name device_wait = 0, acquire = 0, present = 0;  // within a system
  std::vector<telemetry::TraceLog::Track> modelers;                     // by number
  std::vector<telemetry::TraceLog::Name> models;                        // by index in the registry
};

// Begins a trace; none if `log` is null.
Tracing tracing_of(telemetry::TraceLog* log, std::uint32_t modelers,
                   const models::Registry& registry);
// Names the model types after the registry was replaced.
void name_types(const models::Registry& registry, Tracing& trace);
// Adds a track for one more modeler.
void add_modeler(Tracing& trace);
// Adds a span for the last run of each system, with the number of its tick or step. `names`:
// Tracing::systems or Tracing::steps. Does nothing without a trace.
void trace_systems(std::span<const ecs::SystemInfo> systems, std::uint64_t number,
                   std::vector<telemetry::TraceLog::Name> Tracing::*names, Tracing& trace);

}  // namespace psygen::scene
