// A recorded stream of requests: when each mesh was first wanted, what it takes, when it is due,
// how important it was then. What every policy makes of it under the virtual clock
// (schedule_simulator.hpp). For tools and tests, not used by the tick. One thread.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/synthesis/schedule_simulator.hpp"

namespace psygen::synthesis {

// The deadline of a request that has none.
inline constexpr double kNoDeadline = 1e9;
inline constexpr std::size_t kMaxStreamRequests = 10'000'000;
inline constexpr std::size_t kMaxStreamBytes = 96 * kMaxStreamRequests;

// Text: a line "psygen requests 2", then one line for each: arrival in seconds, seconds of one
// core, deadline in seconds or "-", and the rank's bits in hexadecimal. Ordered by arrival.
std::string stream_text(std::vector<SimulatedJob> jobs);
// Fails with kParse, naming `file` and the line. Times must be finite and not negative.
core::Result<std::vector<SimulatedJob>> parse_stream(std::string_view text, std::string_view file);

// How one policy serves the recorded requests.
struct PolicyFigures {
  Policy policy = Policy::kFifo;
  // What was wanted first of all, alone (the initial fill): its makespan, and how much of it
  // modelers had nothing to do.
  double fill_s = 0, fill_idle_percent = 0;
  double visible_p50_s = 0, visible_p99_s = 0,
         visible_max_s = 0;  // from wanted in view to finished
  // Of what was predicted to come into view later than at once: the share that was not finished by
  // then, and how late it was, 0 for what was in time.
  double late_percent = 0;
  double lateness_mean_s = 0, lateness_max_s = 0;
};

// How much work recorded jobs are for a number of modelers.
struct StreamLoad {
  std::size_t requests = 0;
  double span_s = 0;   // from the first to the last arrival
  double work_s = 0;   // of one core
  double percent = 0;  // of what the modelers can do in that time; 0 if it is none
};
StreamLoad load_of(std::span<const SimulatedJob> jobs, unsigned modelers);

// One row for each policy. Deterministic. Requires modelers >= 1.
std::vector<PolicyFigures> compare_policies(std::span<const SimulatedJob> jobs, unsigned modelers);

}  // namespace psygen::synthesis
