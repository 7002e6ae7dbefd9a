// Joins the ledgers of the parts of a job, and says what keeps them from being one: parts of
// another job, blocks that are missing or there twice. Pure; linear in the entries; one thread.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/amplify/ledger.hpp"

namespace psygen::amplify {

// A ledger and its file, for messages.
struct NamedLedger {
  std::filesystem::path file;
  LedgerText ledger;
};

// All ledgers of these files and folders (not of folders inside), in ascending order of their
// names. Fails like read_ledger(), with kIo where a path does not exist, and with kInvalidArgument
// where a folder has none.
core::Result<std::vector<NamedLedger>> read_ledgers(std::span<const std::filesystem::path> paths);

// The figures of the whole job. Fails with kInvalidArgument where ledgers are of different jobs,
// where blocks are missing or twice, or, for jobs with files, where a block's file is not beside
// its ledger; the message names ledgers and blocks.
core::Result<Totals> merge(std::span<const NamedLedger> ledgers);

}  // namespace psygen::amplify
