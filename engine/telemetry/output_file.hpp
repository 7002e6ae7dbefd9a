// The output folder of a run. Files in it are written completely or not at all
// (core/replace_file.hpp). Writes no files. One thread per folder.
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and its parents. Accepts an existing folder, and removes the partial files of
// killed processes from it. Fails with kIo and the path if the folder cannot be created, is not a
// folder, or is not writable.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

}  // namespace psygen::telemetry
