// Checks before the first block that all ranks run the same job. Collective; all ranks get the same
// result. Main thread.
#pragma once

#include <filesystem>

#include "engine/amplify/job_key.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

// Succeeds if all ranks have the same key, and either all or none have a folder. `mine` is this
// rank's key, or the reason why it has none. Fails with kInvalidArgument; the message names the
// first rank that differs from rank 0, its machine and its instruction set.
core::Result<void> check_same_job(const core::Result<amplify::JobKey>& mine, bool with_folder,
                                  Peers& peers);

// Succeeds if all ranks see the same folder: rank 0 creates it and writes a file that the others
// look for. Fails with kIo or kInvalidArgument.
core::Result<void> check_folder(const std::filesystem::path& folder, Peers& peers);

// Returns the first error of any rank to all ranks; `mine` is the result of this rank.
core::Result<void> agree(const core::Result<void>& mine, Peers& peers);
template <class T>
core::Result<void> agree(const core::Result<T>& mine, Peers& peers) {
  return agree(mine ? core::Result<void>{} : tl::unexpected(mine.error()), peers);
}

}  // namespace psygen::cluster
