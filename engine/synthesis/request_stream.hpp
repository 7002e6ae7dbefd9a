// A recorded stream of requests: arrival, duration, deadline and rank of each mesh. Compares the
// policies on it under the virtual clock (schedule_simulator.hpp). For tools and tests, not used by
// the tick. One thread.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/synthesis/schedule_simulator.hpp"

namespace psygen::synthesis {

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
