// What an earlier job left in a folder, and who writes there now. Main thread.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/amplify/ledger.hpp"

namespace psygen::cluster {

// The ledger of a rank in a folder; that of the whole job is "job.ledger".
std::filesystem::path rank_ledger(const std::filesystem::path& folder, unsigned rank);

// Whether the files of finished blocks are looked at: those of an earlier job, one by one.
enum class Check : std::uint8_t { kNothing, kFiles };

// Joins what the ledgers of ranks have into that of the job, with Check::kFiles without entries
// that lost a file, and removes them. For one rank, while no other writes into the folder. Fails
// with kIo, kParse, and kInvalidArgument where they are of another job.
core::Result<void> gather_ledgers(const std::filesystem::path& folder, amplify::Ledger& job,
                                  Check check);

// Opens the ledger of the whole job, locked for this process; removes half-written blocks and
// gathers what an earlier job has left. Fails like Ledger::open() and gather_ledgers().
core::Result<std::unique_ptr<amplify::Ledger>> take_over(const std::filesystem::path& folder,
                                                         const amplify::JobKey& key);

}  // namespace psygen::cluster
