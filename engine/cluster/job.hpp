// One region made by all ranks together: checks that they are of one mind, takes over what an
// earlier job has finished, shares out the rest, and adds up the figures. Main thread; all ranks
// call it with the same arguments but threads.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/amplify/block_files.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

// What came out, at every rank.
struct JobReport {
  amplify::Report report;                  // of all ranks together; seconds: of the last one
  std::uint64_t written = 0, skipped = 0;  // files, of all ranks
  std::uint64_t messages = 0;              // of all ranks
};

// Why a job did not begin or did not end.
struct JobError {
  core::Error error;
  bool common = false;  // every rank has it: one of them should say it
};

// `folder`: for files and ledgers; empty: nothing is written, and nothing is taken over. `options`
// says how this rank runs; its source and sinks are ignored.
//
// Fails before the first block, at every rank, where ranks have different versions, worlds, regions
// or formats, make different bits of the same blocks, or do not see the same folder. Fails like
// BlockFolder::open(), Ledger::open() and amplify(); the caller then calls Peers::abort() unless
// the error is common. A rank that was told to stop returns at once without the others: its report
// is `stopped` and covers its own blocks.
tl::expected<JobReport, JobError> amplify_together(
    const world::World& world, const models::Registry& registry, const amplify::Region& region,
    amplify::JobFormat format, std::string_view version, const std::filesystem::path& folder,
    const amplify::Options& options, Peers& peers);

// Threads for a rank that is not told how many: the processors that it may run on, or its part of
// the machine's, whichever is less; at least one.
unsigned threads_for_rank(unsigned allowed, unsigned of_machine, unsigned ranks_here);

}  // namespace psygen::cluster
