// Programs that a command runs. Main thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cli {

// The words of a command line, separated by blanks; there are no quotes.
std::vector<std::string> words_of(const std::string& command);

// Runs a program to its end, with its output in a file; `environment` ("NAME=VALUE") is added to
// ours. Returns its exit code, or 128 and the number of the signal that ended it. Fails with kIo
// where it cannot be started.
core::Result<int> run_program(std::vector<std::string> words, const std::filesystem::path& log,
                              std::vector<std::string> environment = {});

}  // namespace psygen::cli
