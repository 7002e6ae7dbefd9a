// The subcommands of psygen. Each has a header and a source, NAME_command. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cli {

// Exit code of `psygen`.
enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

// kNoDevice for an error of that code, else kFailed.
inline int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}

// A subcommand. The constructor of its class declares its options.
class Command {
 public:
  virtual ~Command() = default;
  // True if the command line named it.
  bool chosen() const { return command_->parsed(); }
  // Runs the command and returns the exit code.
  virtual int run() = 0;

 protected:
  Command(CLI::App& cli, const char* name, const char* description)
      : command_(cli.add_subcommand(name, description)) {}

  CLI::App* command_;
};

// The subcommands of `cli`, in the order of the help.
std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli);

}  // namespace psygen::cli
