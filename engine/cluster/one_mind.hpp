// What ranks find out about each other before the first block. All ranks call these, and all get
// the same answer. Main thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/amplify/job_key.hpp"
#include "engine/cluster/peers.hpp"

namespace psygen::cluster {

// Whether all ranks have the same key, and all a folder or none does; `mine` may be why this rank
// has no key. Fails with
// kInvalidArgument; the sentence names the first rank that differs from rank 0, its machine and its
// instruction set.
core::Result<void> check_keys(const core::Result<amplify::JobKey>& mine, bool with_folder,
                              Peers& peers);

// Whether all ranks see the same folder: rank 0 creates it and writes a file, which the others look
// for. Fails with kIo or kInvalidArgument.
core::Result<void> check_folder(const std::filesystem::path& folder, Peers& peers);

// Gives every rank the first error of any; `mine` is that of this rank.
core::Result<void> agree(const core::Result<void>& mine, Peers& peers);

}  // namespace psygen::cluster
