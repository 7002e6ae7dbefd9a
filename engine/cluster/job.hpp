// One region synthesised by all ranks together. Checks that all ranks run the same job, resumes an
// earlier job in the folder, distributes the remaining blocks and adds up the statistics.
// Collective, with the same arguments except for the number of threads. Main thread.
#pragma once

#include <filesystem>

#include "engine/amplify/block_files.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

// Result of a job, equal on all ranks.
struct JobReport {
  amplify::Report report;  // of all ranks; its seconds are those of the slowest rank
  std::uint64_t written = 0, skipped = 0;  // files, all ranks
  std::uint64_t messages = 0;              // all ranks
};

// Reason why a job failed.
struct JobError {
  core::Error error;
  bool common = false;  // all ranks have this error: one of them should print it
};

// `key` is that of amplify::job_key(), or the reason why this rank has none. `folder` receives
// files and ledgers. If it is empty, the job writes nothing and resumes nothing. `options` holds
// the settings of this rank; its source and sinks are ignored.
//
// All ranks fail before the first block if they have different versions, worlds, regions or
// formats, compute different bits for the same blocks, or see different folders. Otherwise fails
// like BlockFolder::open(), Ledger::open() and amplify(). The caller then calls Peers::abort(),
// unless the error is common. A rank that receives a stop signal returns at once, without waiting
// for the others: its report is `stopped` and covers only its own blocks.
tl::expected<JobReport, JobError> amplify_together(const world::World& world,
                                                   const models::Registry& registry,
                                                   const core::Result<amplify::JobKey>& key,
                                                   const std::filesystem::path& folder,
                                                   const amplify::Options& options, Peers& peers);

// Default number of threads of a rank: the processors that its affinity allows or the rank's part
// of the machine (of the quota, if there is one), whichever is smaller; at least 1.
unsigned threads_for_rank(unsigned allowed, unsigned of_machine, unsigned ranks_here);
// The default for a rank of this process, on this machine.
unsigned threads_for_rank(const Peers& peers);

}  // namespace psygen::cluster
