#include "engine/scene/frame/output.hpp"

#include <fmt/format.h>

#include "ecs/ecs.hpp"
#include "engine/models/registry.hpp"

namespace psygen::scene {

Tracing tracing_of(telemetry::TraceLog* log, std::uint32_t modelers,
                   const models::Registry& registry) {
  Tracing tracing;
  if (log == nullptr) return tracing;
  tracing.log = log;
  tracing.main = log->add_track("main thread");
  tracing.cache_bytes = log->add_counter("cache bytes");
  tracing.requests = log->add_counter("requests");
  tracing.gpu_ms = log->add_counter("device ms");
  tracing.device_wait = log->intern("wait for the device");
  tracing.acquire = log->intern("wait for the window");
  tracing.present = log->intern("present");
  while (tracing.modelers.size() < modelers)
    add_modeler(tracing);
  name_types(registry, tracing);
  return tracing;
}

void name_types(const models::Registry& registry, Tracing& trace) {
  if (trace.log == nullptr) return;
  trace.models.clear();
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    trace.models.push_back(trace.log->intern(registry[i].name()));
}

void add_modeler(Tracing& trace) {
  trace.modelers.push_back(trace.log->add_track(fmt::format("modeler {}", trace.modelers.size())));
}

void trace_systems(std::span<const ecs::SystemInfo> systems, std::uint64_t number,
                   std::vector<telemetry::TraceLog::Name> Tracing::*names, Tracing& trace) {
  if (trace.log == nullptr) return;
  if ((trace.*names).size() != systems.size()) {
    (trace.*names).clear();
    for (const ecs::SystemInfo& system : systems)
      (trace.*names).push_back(trace.log->intern(system.name));
  }
  for (std::size_t i = 0; i < systems.size(); ++i) {
    const double start_s = systems[i].last_start_s;
    trace.log->add_span(trace.main, (trace.*names)[i], start_s, start_s + systems[i].last_seconds,
                        number);
  }
}

}  // namespace psygen::scene
