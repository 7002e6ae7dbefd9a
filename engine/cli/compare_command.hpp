// `psygen compare`: compares two builds, or two recorded sets of runs (docs/frame-tests.md). Main
// thread.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/compare/compare.hpp"

namespace psygen::cli {

class CompareCommand {
 public:
  explicit CompareCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  std::string misuse() const;
  core::Result<void> collect();
  core::Result<void> record_batch(int batch);
  core::Result<compare::RecordedRun> record(const std::string& command,
                                            const std::filesystem::path& folder) const;

  CLI::App* command_;
  std::string a_, b_, test_;
  std::filesystem::path out_;
  std::size_t pairs_ = 8, aa_ = 0;
  bool json_ = false;
  bool instructions_ = false;
  std::vector<compare::RecordedRun> runs_a_, runs_b_;
};

}  // namespace psygen::cli
