// psygen: the command line. commands.cpp lists the subcommands; this file selects one. Data goes to
// stdout, messages and progress to stderr. Exit codes: 0 success, 1 failure, 2 usage error, 3
// missed budget or regression in B, 4 no usable GPU or display (77 from psygen test).

#include <CLI/CLI.hpp>

#include "engine/cli/commands.hpp"
#include "engine/core/data_file.hpp"
#include "engine/program/command_line.hpp"

namespace psygen::cli {
namespace {

int run(int argc, char** argv) {
  CLI::App cli("psygen: fly through procedural worlds larger than memory", "psygen");
  cli.set_version_flag("--version", "psygen " + std::string(core::version()));
  cli.require_subcommand(1);
  const auto commands = make_commands(cli);
  // After the commands, which would otherwise inherit the footer.
  cli.footer(
      "Example:\n"
      "  psygen fly --headless --world silver_combe --path combe --out out\n"
      "psygen COMMAND --help lists the options of a command.");
  if (const auto code = program::read_command_line(cli, argc, argv)) return *code;
  for (const auto& command : commands)
    if (command->chosen()) return command->run();
  return kUsage;
}

}  // namespace
}  // namespace psygen::cli

int main(int argc, char** argv) {
  return psygen::program::run("psygen", [&] { return psygen::cli::run(argc, argv); });
}
