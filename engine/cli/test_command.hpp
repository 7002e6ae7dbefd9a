// `psygen test`: runs frame tests (docs/frame-tests.md). Main thread.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/frametest/run.hpp"

namespace psygen::cli {

class TestCommand {
 public:
  explicit TestCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  CLI::App* command_;
  frametest::RunOptions options_;
};

}  // namespace psygen::cli
