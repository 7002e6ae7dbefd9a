#include <fmt/format.h>

#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// Modelers that replace hung ones get tracks of their own; what the main thread did itself is seen
// in its cache system. In virtual time nothing is traced: its jobs have no place on the real clock
// of the trace.
void trace_job(const synthesis::Completion& job, Tracing& trace) {
  if (job.modeler == synthesis::kMainThreadModeler) return;
  while (trace.modelers.size() <= job.modeler) {
    trace.modelers.push_back(
        trace.log->add_track(fmt::format("modeler {}", trace.modelers.size())));
  }
  trace.log->add_span(trace.modelers[job.modeler], trace.models[job.key.model], job.started_s,
                      job.finished_s);
}

}  // namespace

void synthesis_system(const Settings& settings, const Rules& rules, synthesis::MeshSupply& meshes,
                      Counters& counters, Tracing& trace) {
  if (rules.wait) meshes.wait();
  for (const synthesis::Completion& job : meshes.collect()) {
    ++(job.ok ? counters.completed : counters.failed);
    if (!job.remote) counters.synthesis_seconds += job.seconds;
    if (job.ok && !job.remote)
      counters.costs.push_back({job.predicted_seconds, job.seconds, job.key.model});
    if (trace.log != nullptr && !job.late && !settings.virtual_time) trace_job(job, trace);
  }
}

}  // namespace psygen::scene
