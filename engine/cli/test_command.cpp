// `psygen test`: runs frame tests (docs/frame-tests.md).
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/core/log.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::cli {
namespace {

class TestCommand final : public Command {
 public:
  explicit TestCommand(CLI::App& cli)
      : Command(cli, "test", "Run frame tests and check their budgets") {
    CLI::App& c = *command_;
    c.add_option("FILE", options_.files, "Frame tests: TOML files")->required();
    c.add_option("--junit", options_.junit, "Write the results to this file as JUnit XML");
    c.add_option("--out", options_.out, "Folder for the outputs, with one subfolder per test");
    c.add_option("--worst", options_.worst_frames,
                 "Number of worst frames of a failed test written as images to --out")
        ->capture_default_str()
        ->transform(integer_between(0, frametest::kMaxWorstFrames));
    c.add_option("--device", options_.device, "Part of the Vulkan device's name");
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
