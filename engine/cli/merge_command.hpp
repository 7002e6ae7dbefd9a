// `psygen merge`: merges the ledgers of shards. Main thread.
#pragma once

#include <string>
#include <vector>

#include "engine/cli/commands.hpp"

namespace psygen::cli {

// The command.
class MergeCommand final : public Command {
 public:
  explicit MergeCommand(CLI::App& cli);
  int run() override;

 private:
  std::vector<std::string> paths_;
  bool json_ = false;
};

}  // namespace psygen::cli
