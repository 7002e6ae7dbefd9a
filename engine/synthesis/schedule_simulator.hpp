// What a policy would do, under a virtual clock: N modelers take the first job of the order
// whenever they are free. Deterministic to the bit on every machine, no threads, no model is run.
// For comparing policies on recorded request streams; not used by the tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/synthesis/policy.hpp"

namespace psygen::synthesis {

// One request to simulate.
struct SimulatedJob {
  double arrival_s = 0;   // before it the job is unknown
  double seconds = 0;     // what it takes; the prediction is assumed to be right
  double deadline_s = 0;  // absolute; when it should be finished
  Rank rank;
};

// When a job ran.
struct SimulatedRun {
  double start_s = 0, finish_s = 0;
  std::uint32_t modeler = 0;
};

// The result of a simulation.
struct SimulationResult {
  std::vector<SimulatedRun> runs;  // as the jobs were given
  double makespan_s = 0;           // when the last one is finished
  double mean_wait_s = 0;          // from arrival to finish
  double mean_lateness_s = 0;      // max(0, finish − deadline)
  double max_lateness_s = 0;
  double idle_seconds = 0;  // of all modelers until the makespan
};

// Ties go to the lower job and the lower modeler. O(n log n + n · modelers) for jobs that arrive
// together. Requires modelers >= 1 and finite times.
SimulationResult simulate(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy);

}  // namespace psygen::synthesis
