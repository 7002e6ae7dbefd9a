// `psygen test`: runs frame tests (docs/frame-tests.md).
#include "engine/cli/commands.hpp"
#include "engine/core/log.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::cli {
namespace {

class TestCommand final : public Command {
 public:
  explicit TestCommand(CLI::App& cli)
      : Command(cli, "test", "Run frame tests and check their budgets") {
    frametest::add_options(*command_, options_);
  }

  int run() override {
    options_.stop = &stop_at_interrupt();
    return frametest::run_frame_tests(options_);
  }

 private:
  frametest::RunOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_test_command(CLI::App& cli) {
  return std::make_unique<TestCommand>(cli);
}

}  // namespace psygen::cli
