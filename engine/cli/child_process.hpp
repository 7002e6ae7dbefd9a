// Runs other programs for a command. Main thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cli {

// The words of a command line, separated by blanks; quotes are not supported.
std::vector<std::string> words_of(const std::string& command);

// Runs a program to its end and writes its output to a file; `environment` ("NAME=VALUE") is added
// to that of this process. Returns its exit code, or 128 plus the number of the signal that ended
// it. Fails with kIo if it cannot be started.
core::Result<int> run_program(std::vector<std::string> words, const std::filesystem::path& log,
                              std::vector<std::string> environment = {});

}  // namespace psygen::cli
