// Replaces a file's content as a whole: after a crash or a full disk the old content or the new
// content is there, never a mix. POSIX. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/core/error.hpp"

namespace psygen::core {

// Writes a temporary file in the same folder, fsync, rename, fsync of the folder. The temporary
// file is removed when anything fails. Refuses a path that exists and is not a regular file.
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

// Removes the temporary files that replace_file() of processes which no longer run (killed, no
// power) left in the folder. Not that of its sub-folders.
void remove_stale_partials(const std::filesystem::path& folder);

}  // namespace psygen::core
