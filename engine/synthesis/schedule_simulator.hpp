// Simulates a policy under a virtual clock: each of N modelers takes the first job of the order
// whenever it is free. Bit-identical on every machine; runs no threads and no models. Compares
// policies on recorded request streams; not used by the tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/synthesis/policy.hpp"

namespace psygen::synthesis {

// One request to simulate.
struct SimulatedJob {
  double arrival_s = 0;   // before it, the job is unknown
  double seconds = 0;     // duration; the prediction is assumed to be exact
  double deadline_s = 0;  // absolute time by which it should be finished
  Rank rank;
};

// Time and modeler of a job.
struct SimulatedRun {
  double start_s = 0, finish_s = 0;
  std::uint32_t modeler = 0;
};

// The result of a simulation.
struct SimulationResult {
  std::vector<SimulatedRun> runs;  // in the order of the jobs
  double makespan_s = 0;           // end of the last job
  double mean_wait_s = 0;          // from arrival to finish
  double mean_lateness_s = 0;      // max(0, finish − deadline)
  double max_lateness_s = 0;
  double idle_seconds = 0;  // of all modelers until the makespan
};

// Ties go to the lower job and the lower modeler. O(n log n + n · modelers) for jobs that arrive
// together. Requires modelers >= 1 and finite times.
SimulationResult simulate(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy);

}  // namespace psygen::synthesis
