#include "engine/cli/test_command.hpp"

#include "engine/cli/interrupt.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/core/log.hpp"
#include "engine/render/software_tuning.hpp"

namespace psygen::cli {

TestCommand::TestCommand(CLI::App& cli)
    : command_(cli.add_subcommand("test", "Run frame tests and judge them by their budgets")) {
  CLI::App& c = *command_;
  c.add_option("FILE", options_.files, "Frame tests: TOML files")->required();
  c.add_option("--junit", options_.junit, "File that gets the results as JUnit XML");
  c.add_option("--out", options_.out, "Folder that keeps the outputs, one folder for each test");
  c.add_option("--worst", options_.worst_frames,
               "Pictures of the worst frames of a failed test, in --out; 0: none")
      ->capture_default_str()
      ->transform(integer_between(0, frametest::kMaxWorstFrames));
  c.add_option("--device", options_.device, "Part of the name of the Vulkan device");
}

int TestCommand::run() {
  options_.stop = &stop_at_interrupt();
  if (auto ok = render::fit_software_rendering_to_threads(); !ok) {
    core::log_error(ok.error().message);
    return frametest::kFailed;
  }
  return frametest::run_frame_tests(options_);
}

}  // namespace psygen::cli
