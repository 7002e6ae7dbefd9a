// Rules that hold for every option of every command, and the messages for usage errors. Independent
// of the commands; CLI11 parses.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace psygen::cli {

// Parses the command line into the commands of `cli`. Returns nullopt if a command was chosen, else
// the exit code: after --help and --version, which print to stdout, and after usage errors, which
// print to stderr with a suggestion for a misspelt word.
std::optional<int> read_command_line(CLI::App& cli, int argc, char** argv);

}  // namespace psygen::cli
