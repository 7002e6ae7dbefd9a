// `psygen compare --instructions`: compares two commands under callgrind. Main thread.
#pragma once

#include <filesystem>
#include <string>

namespace psygen::cli {

struct InstructionOptions {
  std::string a, b;           // commands; a bare program amplifies a few blocks
  std::filesystem::path out;  // for callgrind's files and compare.json
  bool json = false;
};

// Runs both commands, prints the verdict, and returns the exit code: 0; 3 if B executes over 1 %
// more instructions; 77 if valgrind is missing or cannot run a command; otherwise 1.
int compare_instructions(const InstructionOptions& options);

}  // namespace psygen::cli
