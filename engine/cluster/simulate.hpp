// A job under a virtual clock: what plan (plan.hpp), threads and claims make of given costs, and of
// the limits of a network and a file system. No process, no thread and no block is made; the
// figures are the same on every machine. For tests of the balance, and for `psygen schedule
// --ranks`. Pure.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "engine/cluster/plan.hpp"

namespace psygen::cluster {

// What a machine room can do. Without limits by default.
struct MachineLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double claim_latency_s = 0;               // from asking rank 0 to having the answer
  double claims_per_second = kNone;         // that rank 0's network card answers
  double rank_bytes_per_second = kNone;     // from a rank to the file system
  double storage_bytes_per_second = kNone;  // of the file system, all ranks together
  double storage_files_per_second = kNone;  // created and renamed: metadata
  double file_latency_s = 0;                // of each file, until it is on the disk
};

// What is run.
struct VirtualJob {
  unsigned ranks = 1, threads = 1;  // threads of each rank
  unsigned cores = 0;               // of each rank; 0: as many as threads
  // What blocks take of one core, and how many bytes their files have; 0: no files.
  std::function<double(const amplify::BlockRun&)> seconds_of;
  std::function<double(const amplify::BlockRun&)> bytes_of;
  MachineLimits limits;
  // A thread takes at most so many blocks at a time.
  std::uint64_t max_blocks_per_run = 64;
};

// Shares are 0 … 1.
struct VirtualReport {
  double makespan_s = 0;
  double core_seconds = 0;     // of all blocks
  double efficiency = 0;       // core_seconds / (makespan · ranks · cores)
  double worst_rank_idle = 0;  // share of its time in which the idlest rank waits at the end
  std::uint64_t claims = 0;
  std::vector<double> rank_busy_s, rank_end_s;  // seconds of threads; when its last thread ended
  // Share of the makespan in which each part was busy.
  double storage_busy = 0, metadata_busy = 0, link_busy = 0, claims_busy = 0;
};

// Writes are queued in the order in which blocks become ready, first come first served. O(runs log
// threads).
VirtualReport simulate(const Plan& plan, const VirtualJob& job);

}  // namespace psygen::cluster
