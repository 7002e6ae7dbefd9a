// Reads a whole file into memory, up to a limit. Not for files that change during the read, and not
// for text (world/files/text_file.hpp). Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {

// Returns the bytes of a regular file. Allocates nothing if the file has more than `max_bytes`
// bytes. Fails with kIo or kOverBudget; the message starts with the path. Throws std::bad_alloc.
Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                            std::uint64_t max_bytes);

}  // namespace psygen::core
