// A recorded stream of requests: arrival, duration, deadline and rank of each mesh. Compares the
// policies on it under a virtual clock. For tools and tests, not used by
// the tick. One thread.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
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

// Simulates a policy under a virtual clock: each of N modelers takes the first job of the order
// whenever it is free. Bit-identical on every machine; runs no threads and no models. Ties go to
// the lower job and the lower modeler. O(n log n + n · modelers) for jobs that arrive together.
// Requires modelers >= 1 and finite times.
SimulationResult simulate(std::span<const SimulatedJob> jobs, unsigned modelers, Policy policy);

// Deadline of a request without one.
inline constexpr double kNoDeadline = 1e9;
inline constexpr std::size_t kMaxStreamRequests = 10'000'000;
inline constexpr std::size_t kMaxStreamBytes = 96 * kMaxStreamRequests;

// Text format: a line "psygen requests 2", then one line for each request: arrival in seconds,
// seconds of one core, deadline in seconds or "-", and the rank's bits in hexadecimal. Ordered by
// arrival.
std::string stream_text(std::vector<SimulatedJob> jobs);
// Fails with kParse, naming `file` and the line. Times must be finite and not negative.
core::Result<std::vector<SimulatedJob>> parse_stream(std::string_view text, std::string_view file);

// Results of one policy on the recorded requests.
struct PolicyStats {
  Policy policy = Policy::kFifo;
  // Initial fill: makespan of the requests that arrive first, served alone, and the fraction of it
  // in which modelers are idle.
  double fill_s = 0, fill_idle_percent = 0;
  double visible_p50_s = 0, visible_p99_s = 0,
         visible_max_s = 0;  // from wanted in view to finished
  // Of requests predicted to come into view later: the fraction that missed its deadline, and the
  // lateness, 0 for those in time.
  double late_percent = 0;
  double lateness_mean_s = 0, lateness_max_s = 0;
};

// Load of the recorded jobs for a number of modelers.
struct StreamLoad {
  std::size_t requests = 0;
  double span_s = 0;   // from the first to the last arrival
  double work_s = 0;   // of one core
  double percent = 0;  // of the modelers' capacity in that span; 0 for an empty span
};
StreamLoad load_of(std::span<const SimulatedJob> jobs, unsigned modelers);

// One row for each policy. Deterministic. Requires modelers >= 1.
std::vector<PolicyStats> compare_policies(std::span<const SimulatedJob> jobs, unsigned modelers);

}  // namespace psygen::synthesis
