// psygen: the command line. One subcommand a file; this one only chooses. Data goes to stdout,
// messages and progress to stderr.
// Exit codes: 0 ok, 1 failed, 2 usage, 4 no usable device or display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "engine/core/log.hpp"
#include "engine/render/software_tuning.hpp"
#include "game/commands.hpp"
#include "game/fatal.hpp"
#include "game/interrupt.hpp"

namespace psygen::game {

int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kOk;
  if (errno != EPIPE)
    core::log_error(fmt::format("standard output cannot be written: {}", std::strerror(errno)));
  return kFailed;
}

}  // namespace psygen::game

int main(int argc, char** argv) {
  psygen::render::tune_allocator_for_software_rendering();  // before the first allocation of size
  psygen::game::say_why_at_terminate();
  psygen::game::ignore_what_write_errors_say();

  CLI::App cli("psygen: fly through worlds that are far larger than memory", "psygen");
  cli.set_version_flag("--version", "psygen " PSYGEN_VERSION);
  cli.require_subcommand(1);
  psygen::game::FlyCommand fly(cli);
  psygen::game::ModelsCommand models(cli);
  psygen::game::AmplifyCommand amplify(cli);
  psygen::game::ExportCommand exporter(cli);
  psygen::game::CalibrateCommand calibrate(cli);
  psygen::game::ScheduleCommand schedule(cli);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for = error.get_exit_code() == 0;  // --help, --version
    cli.exit(error, std::cout, std::cerr);
    if (asked_for) return std::cout.flush() ? psygen::game::kOk : psygen::game::kFailed;
    return psygen::game::kUsage;
  }
  // Nothing of ours throws, but libraries do when memory ends.
  try {
    if (fly.chosen()) return fly.run();
    if (amplify.chosen()) return amplify.run();
    if (exporter.chosen()) return exporter.run();
    if (calibrate.chosen()) return calibrate.run();
    if (schedule.chosen()) return schedule.run();
    return models.run();
  } catch (...) {
    return psygen::game::say_what_was_thrown();
  }
}
