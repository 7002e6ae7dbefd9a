// The folder for a run's output. Files in it are written whole or not at all
// (core/replace_file.hpp). Not a file writer itself. One thread per folder.
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and its parents. An existing folder is fine; half-written files of processes
// that were killed are removed from it. Fails with kIo and the path when the folder cannot be
// created, is not a folder, or cannot be written to.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

}  // namespace psygen::telemetry
