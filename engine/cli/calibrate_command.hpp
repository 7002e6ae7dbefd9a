// `psygen calibrate`. Main thread.
#pragma once

#include <string>

#include "engine/cli/commands.hpp"
#include "engine/cli/shipped_files.hpp"

namespace psygen::cli {

// The command.
class CalibrateCommand final : public Command {
 public:
  explicit CalibrateCommand(CLI::App& cli);
  int run() override;

 private:
  std::string out_, world_ = kDefaultWorld;
  bool ranges_ = false;
  std::size_t samples_ = 64;
  bool json_ = false;
};

}  // namespace psygen::cli
