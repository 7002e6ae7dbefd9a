// `psygen merge`: merges the ledgers of shards. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace psygen::cli {

class MergeCommand {
 public:
  explicit MergeCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::vector<std::string> paths_;
  bool json_ = false;
};

}  // namespace psygen::cli
