// The folder that outputs go to. What is written there is there whole or not at all
// (core/replace_file.hpp).
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and those above it; one that exists already is fine, and loses the
// half-written files of processes that were killed. Fails with kIo and the path when it cannot be
// created, is no folder, or nothing can be written into it.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

}  // namespace psygen::telemetry
