// Joins the ledgers of the parts of a job, and reports errors that prevent this: parts of another
// job, and missing or duplicate blocks. Pure; linear in the entries; one thread.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/amplify/ledger.hpp"

namespace psygen::amplify {

// A ledger and its file, for messages.
struct NamedLedger {
  std::filesystem::path file;
  LedgerText ledger;
};

// All ledgers of these files and folders (not of subfolders), in ascending order of their names.
// Fails like read_ledger(), with kIo if a path does not exist, and with kInvalidArgument if a
// folder has none.
core::Result<std::vector<NamedLedger>> read_ledgers(std::span<const std::filesystem::path> paths);

// The totals of the whole job. Fails with kInvalidArgument if ledgers belong to different jobs, if
// blocks are missing or duplicate, or, for jobs with files, if a block's file is not next to its
// ledger; the message names ledgers and blocks.
core::Result<Totals> merge(std::span<const NamedLedger> ledgers);

}  // namespace psygen::amplify
