// `psygen history bisect`: drives `git bisect run` with a judgement of each commit by the entries
// of a history. Runs git and the user's command as processes. Main thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace psygen::cli {

struct BisectOptions {
  std::filesystem::path history;
  std::string good, bad;             // commits
  std::vector<std::string> command;  // builds a commit and writes runs into $PSYGEN_OUT
  std::string test, figure, machine;
  std::size_t runs = 5;
};

// Bisects the repository of the current folder and prints the first bad commit. Returns an exit
// code.
int run_bisect(const BisectOptions& options);

// Judges the commit that is checked out. Returns an exit code of `git bisect run`: 0 good, 1 bad,
// 125 to skip it (the command fails, or nothing can be told), 128 to stop.
int judge_bisected_commit(const BisectOptions& options);

}  // namespace psygen::cli
