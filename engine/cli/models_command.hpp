// `psygen models`. Main thread.
#pragma once

#include <string>

#include "engine/cli/commands.hpp"

namespace psygen::cli {

// The command.
class ModelsCommand final : public Command {
 public:
  explicit ModelsCommand(CLI::App& cli);
  int run() override;

 private:
  std::string world_;
  bool json_ = false;
};

}  // namespace psygen::cli
