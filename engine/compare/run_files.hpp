// Texts of the files of a run. Any thread.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/error.hpp"

namespace psygen::compare {

struct RunFiles {
  std::string frames_csv, summary_json;
};

// Reads frames.csv and summary.json of a folder. Fails with kIo, naming the file.
core::Result<RunFiles> read_run_files(const std::filesystem::path& folder);

}  // namespace psygen::compare
