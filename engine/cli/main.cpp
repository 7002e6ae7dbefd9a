// psygen: the command line. commands.cpp lists the subcommands; this file selects one. Data goes to
// stdout, messages and progress to stderr. Exit codes: 0 success, 1 failure, 2 usage error, 3
// missed budget or regression in B, 4 no usable GPU or display (77 from psygen test).

#include <CLI/CLI.hpp>

#include "engine/cli/commands.hpp"
#include "engine/cli/fatal.hpp"
#include "engine/cli/interrupt.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/cli/usage.hpp"
#include "engine/core/data_file.hpp"
#include "engine/render/device/software_tuning.hpp"

int main(int argc, char** argv) {
  psygen::cli::reserve_standard_streams();
  psygen::render::tune_allocator_for_software_rendering();  // before the first large allocation
  psygen::cli::install_terminate_handler();
  psygen::cli::ignore_write_signals();

  CLI::App cli("psygen: fly through procedural worlds larger than memory", "psygen");
  cli.set_version_flag("--version", "psygen " + std::string(psygen::core::version()));
  cli.require_subcommand(1);
  const auto commands = psygen::cli::make_commands(cli);
  // After the commands, which would otherwise inherit the footer.
  cli.footer(
      "Example:\n"
      "  psygen fly --headless --world silver_combe --path combe --out out\n"
      "psygen COMMAND --help lists the options of a command.");
  if (const auto code = psygen::cli::read_command_line(cli, argc, argv)) return *code;
  // psygen throws nothing, but libraries do when memory runs out.
  try {
    for (const auto& command : commands)
      if (command->chosen()) return command->run();
  } catch (...) {
    return psygen::cli::report_current_exception();
  }
  return psygen::cli::kUsage;
}
