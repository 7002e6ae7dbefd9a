// Simulates a job under a virtual clock: the plan (plan.hpp), threads and claims under given costs
// and the limits of a network and a file system. Runs no process, no thread and no synthesis;
// results are the same on every machine. For balance tests and for `psygen schedule --ranks`. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "engine/cluster/plan.hpp"

namespace psygen::cluster {

// Limits of the machines. Unlimited by default.
struct MachineLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double claim_latency_s = 0;               // from asking rank 0 to receiving the answer
  double claims_per_second = kNone;         // answered by rank 0's network card
  double rank_bytes_per_second = kNone;     // from a rank to the file system
  double storage_bytes_per_second = kNone;  // of the file system, for all ranks together
  double storage_files_per_second = kNone;  // created and renamed: metadata
  double file_latency_s = 0;                // until a file is on disk
};

// The job to simulate.
struct VirtualJob {
  unsigned ranks = 1, threads = 1;  // threads of each rank
  unsigned cores = 0;               // of each rank; 0: the number of threads
  // Seconds of one core for a run of blocks, and bytes of its files; 0 bytes: no files.
  std::function<double(const amplify::BlockRun&)> seconds_of;
  std::function<double(const amplify::BlockRun&)> bytes_of;
  MachineLimits limits;
  // Largest number of blocks that a thread takes at a time.
  std::uint64_t max_blocks_per_run = 64;
};

// Result. Fractions are 0 … 1.
struct VirtualReport {
  double makespan_s = 0;
  double core_seconds = 0;     // of all blocks
  double efficiency = 0;       // core_seconds / (makespan · ranks · cores)
  double worst_rank_idle = 0;  // fraction of the time in which the idlest rank waits at the end
  std::uint64_t claims = 0;
  std::vector<double> rank_busy_s, rank_end_s;  // seconds of threads; end of the last thread
  // Fraction of the makespan in which each resource was busy.
  double storage_busy = 0, metadata_busy = 0, link_busy = 0, claims_busy = 0;
};

// Writes queue in the order in which blocks become ready (first come, first served). O(runs log
// threads).
VirtualReport simulate(const Plan& plan, const VirtualJob& job);

}  // namespace psygen::cluster
