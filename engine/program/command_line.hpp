// Command lines in the manner of psygen: messages for usage errors with a suggestion for a misspelt
// word, and rules that hold for every option. CLI11 parses.
#pragma once

#include <optional>

namespace CLI {
class App;
}

namespace psygen::program {

// Parses the command line into `cli`, whose name is the program's, and into its commands if it has
// any. Returns nullopt if the program shall run, else the exit code: after --help and --version,
// which print to stdout, and after usage errors, which print to stderr.
std::optional<int> read_command_line(CLI::App& cli, int argc, char** argv);

}  // namespace psygen::program
