// Reads a whole text file. Not for binary data. Any thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "engine/core/error.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

// The bytes of a file. Fails with kIo if `file` is not a readable regular file, and with
// kOverBudget if it has more than `limit_bytes`. The buffer grows while reading, to at most twice
// the size of the file.
core::Result<std::string> read_text_file(const std::filesystem::path& file,
                                         std::size_t limit_bytes = kMaxFileBytes);

}  // namespace psygen::world
