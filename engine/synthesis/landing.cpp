#include "engine/synthesis/landing.hpp"

#include <utility>

namespace psygen::synthesis {

LandingReport land(std::span<Completion> completions, GeometryCache& cache, CostModel* cost) {
  LandingReport report;
  for (Completion& c : completions) {
    if (c.late) {
      cache.settle(c.handle);
      ++report.settled;
    } else if (!c.ok) {
      cache.fail(c.handle, c.error, c.abandoned);
      ++report.failed;
    } else {
      if (cost != nullptr && !c.remote) {
        cost->observe(c.key.model, c.key.level, c.work, c.warmth, c.predicted_seconds, c.seconds);
      }
      cache.complete(c.handle, c.tight, std::move(c.note));
      const MeshRecord* record = cache.get(c.handle);  // may be evicted or released by now
      if (record == nullptr || record->state != MeshState::kReady) continue;
      ++report.ready;
      report.bytes += record->range.bytes;
    }
  }
  return report;
}

}  // namespace psygen::synthesis
