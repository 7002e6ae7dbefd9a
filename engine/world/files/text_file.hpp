// Reads a text file whole. Not for data: files above the limit are refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "engine/core/error.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

// Fails with kIo if `file` is not a regular file that can be read, and with kOverBudget if it has
// more than `limit_bytes`. Takes memory as it reads: for no more than twice the file.
core::Result<std::string> read_text_file(const std::filesystem::path& file,
                                         std::size_t limit_bytes = kMaxFileBytes);

}  // namespace psygen::world
