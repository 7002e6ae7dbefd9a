// Reads a small text file whole. Not for data: files above the limit are refused unread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "engine/core/error.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

// Fails with kIo if `file` is not a regular file that can be read, and with kOverBudget if it has
// more than kMaxFileBytes.
core::Result<std::string> read_text_file(const std::filesystem::path& file);

}  // namespace psygen::world
