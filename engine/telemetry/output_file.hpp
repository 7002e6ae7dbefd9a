// Where outputs go: the folder, and texts that are there whole or not at all. What is written piece
// by piece is a core::FileReplacement.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and those above it; one that exists already is fine, and loses the
// half-written files of processes that were killed. Fails with kIo and the path when it cannot be
// created, is no folder, or nothing can be written into it.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

// Replaces the whole file. Fails with kIo, the path and the reason.
core::Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace psygen::telemetry
