// Statistics of the manager and of its modelers.
#include <algorithm>

#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::synthesis {

ModelerStats SynthesisManager::stats_of(const Modeler& modeler) {
  const ModelerCounters& c = modeler.counters();
  return {modeler.number(),
          c.models.load(std::memory_order_relaxed),
          c.failed.load(std::memory_order_relaxed),
          c.triangles.load(std::memory_order_relaxed),
          c.bytes.load(std::memory_order_relaxed),
          c.cpu_seconds.load(std::memory_order_relaxed),
          c.busy_seconds.load(std::memory_order_relaxed),
          c.locks.load(std::memory_order_relaxed),
          c.retries.load(std::memory_order_relaxed),
          modeler.is_remote()};
}

SynthesisStats SynthesisManager::stats() const {
  SynthesisStats s;
  s.published = published_;
  s.reclaimed = reclaimed_;
  s.given_up = given_up_;
  s.modelers = buried_;
  if (here_.finished() > 0) s.modelers.push_back(stats_of(here_));
  for (const Worker& w : active_)
    s.modelers.push_back(stats_of(*w.modeler));
  for (const Worker& w : retired_)
    s.modelers.push_back(stats_of(*w.modeler));
  std::sort(s.modelers.begin(), s.modelers.end(),
            [](const ModelerStats& a, const ModelerStats& b) { return a.modeler < b.modeler; });
  for (const ModelerStats& m : s.modelers) {
    s.models += m.models;
    s.failed += m.failed;
    s.triangles += m.triangles;
    s.bytes += m.bytes;
    s.cpu_seconds += m.cpu_seconds;
  }
  return s;
}

}  // namespace psygen::synthesis
