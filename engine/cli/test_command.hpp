// `psygen test`: runs frame tests (docs/frame-tests.md). Main thread.
#pragma once

#include "engine/cli/commands.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::cli {

// The command.
class TestCommand final : public Command {
 public:
  explicit TestCommand(CLI::App& cli);
  int run() override;

 private:
  frametest::RunOptions options_;
};

}  // namespace psygen::cli
