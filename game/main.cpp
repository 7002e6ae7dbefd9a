// psygen: the command line. One subcommand a file; this one only chooses. Data goes to stdout,
// messages and progress to stderr.
// Exit codes: 0 ok, 1 failed, 2 usage, 4 no usable device or display.
#include <CLI/CLI.hpp>
#include <iostream>

#include "engine/render/software_tuning.hpp"
#include "game/commands.hpp"

namespace psygen::game {

int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}

}  // namespace psygen::game

int main(int argc, char** argv) {
  psygen::render::tune_allocator_for_software_rendering();  // before the first allocation of size

  CLI::App cli("psygen: fly through worlds that are far larger than memory", "psygen");
  cli.set_version_flag("--version", "psygen " PSYGEN_VERSION);
  cli.require_subcommand(1);
  psygen::game::FlyCommand fly(cli);
  psygen::game::ModelsCommand models(cli);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for = error.get_exit_code() == 0;  // --help, --version
    cli.exit(error, std::cout, std::cerr);
    return asked_for ? 0 : psygen::game::kUsage;
  }
  if (fly.chosen()) return fly.run();
  return models.run();
}
