// The command line as a whole: what holds for every option of every command, and what somebody is
// told who got it wrong. Knows no command by name; CLI11 parses.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace psygen::cli {

// Reads the command line into the commands of `cli`. None where one was chosen, else the exit code
// to leave with: after --help and --version, which go to stdout, and after mistakes, which are told
// on stderr, with the nearest word for a misspelt one.
std::optional<int> read_command_line(CLI::App& cli, int argc, char** argv);

}  // namespace psygen::cli
