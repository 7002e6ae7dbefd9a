// `psygen compare --instructions`: two commands under callgrind. Main thread.
#pragma once

#include <filesystem>
#include <string>

namespace psygen::cli {

struct InstructionOptions {
  std::string a, b;           // commands; a program without words amplifies a few blocks
  std::filesystem::path out;  // of callgrind's files and compare.json
  bool json = false;
};

// Runs both, prints the verdict, and returns the exit code: 0, 3 where B executes over 1 % more, 77
// where valgrind is missing or cannot run one of them, else 1.
int compare_instructions(const InstructionOptions& options);

}  // namespace psygen::cli
