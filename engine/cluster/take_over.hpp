// Resumes an earlier job in a folder and locks the folder for this one. Main thread.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/amplify/ledger.hpp"

namespace psygen::cluster {

// Path of a rank's ledger in a folder; the ledger of the whole job is "job.ledger".
std::filesystem::path rank_ledger(const std::filesystem::path& folder, unsigned rank);

// kFiles checks that every finished block of an earlier job still has its files.
enum class Check : std::uint8_t { kNothing, kFiles };

// Merges the ledgers of all ranks into the ledger of the job, and removes them. With Check::kFiles,
// drops entries that lost a file. For one rank, while no other writes into the folder. Fails with
// kIo, with kParse, and with kInvalidArgument if the ledgers belong to another job.
core::Result<void> gather_ledgers(const std::filesystem::path& folder, amplify::Ledger& job,
                                  Check check);

// Opens the ledger of the whole job, locked for this process; removes half-written blocks and
// merges the ledgers of an earlier job. Fails like Ledger::open() and gather_ledgers().
core::Result<std::unique_ptr<amplify::Ledger>> take_over(const std::filesystem::path& folder,
                                                         const amplify::JobKey& key);

}  // namespace psygen::cluster
