// `psygen convert`: converts the frames of a recorded run for other viewers. Main thread.
#pragma once

#include <string>

#include "engine/cli/commands.hpp"

namespace psygen::cli {

// The command.
class ConvertCommand final : public Command {
 public:
  explicit ConvertCommand(CLI::App& cli);
  int run() override;

 private:
  std::string run_, viewer_, out_;
};

}  // namespace psygen::cli
