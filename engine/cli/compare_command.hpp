// `psygen compare`: compares two builds, or two recorded sets of runs (docs/frame-tests.md). Main
// thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/cli/commands.hpp"
#include "engine/compare/compare.hpp"
#include "engine/compare/instructions.hpp"

namespace psygen::cli {

// The command.
class CompareCommand final : public Command {
 public:
  explicit CompareCommand(CLI::App& cli);
  int run() override;

 private:
  std::string misuse() const;
  core::Result<void> collect();
  core::Result<void> record_batch(int batch);
  core::Result<compare::RecordedRun> record(const std::string& command,
                                            const std::filesystem::path& folder) const;
  core::Result<compare::Instructions> count_instructions() const;
  int compare_instructions() const;

  std::string a_, b_, test_;  // commands or folders; a bare program may count instructions
  std::filesystem::path out_;
  std::size_t pairs_ = 8, aa_ = 0;
  bool json_ = false, instructions_ = false;
  std::vector<compare::RecordedRun> runs_a_, runs_b_;
};

}  // namespace psygen::cli
