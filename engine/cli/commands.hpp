// The subcommands of psygen. Each has a source, NAME_command.cpp. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::cli {

// Exit code of `psygen`.
enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

// kNoDevice for an error of that code, else kFailed.
inline int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}
// Logs the error and returns its exit code.
int fail_with(const core::Error& error);
// Writes data to stdout. Returns kFailed if it cannot be written, with a message unless the reader
// has closed the pipe.
int print(const std::string& text);

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

// Each adds one subcommand to `cli`.
std::unique_ptr<Command> make_amplify_command(CLI::App& cli);
std::unique_ptr<Command> make_calibrate_command(CLI::App& cli);
std::unique_ptr<Command> make_compare_command(CLI::App& cli);
std::unique_ptr<Command> make_convert_command(CLI::App& cli);
std::unique_ptr<Command> make_export_command(CLI::App& cli);
std::unique_ptr<Command> make_fly_command(CLI::App& cli);
std::unique_ptr<Command> make_merge_command(CLI::App& cli);
std::unique_ptr<Command> make_models_command(CLI::App& cli);
std::unique_ptr<Command> make_picture_command(CLI::App& cli);
std::unique_ptr<Command> make_schedule_command(CLI::App& cli);
std::unique_ptr<Command> make_test_command(CLI::App& cli);
// Adds all subcommands, in the order of the help.
std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli);

}  // namespace psygen::cli
