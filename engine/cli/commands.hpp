// The subcommands of psygen. Each has a source, NAME_command.cpp. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "engine/program/program.hpp"

namespace psygen::cli {

// Names that all commands use.
using program::exit_code_of;
using program::fail_with;
using program::print;
using program::stop_at_interrupt;
using enum program::ExitCode;

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
std::unique_ptr<Command> make_devices_command(CLI::App& cli);
std::unique_ptr<Command> make_doctor_command(CLI::App& cli);
std::unique_ptr<Command> make_export_command(CLI::App& cli);
std::unique_ptr<Command> make_fly_command(CLI::App& cli);
std::unique_ptr<Command> make_history_command(CLI::App& cli);
std::unique_ptr<Command> make_merge_command(CLI::App& cli);
std::unique_ptr<Command> make_models_command(CLI::App& cli);
std::unique_ptr<Command> make_picture_command(CLI::App& cli);
std::unique_ptr<Command> make_schedule_command(CLI::App& cli);
std::unique_ptr<Command> make_test_command(CLI::App& cli);
// Adds the subcommands that draw to a build without the renderer. They only fail, with a message.
void add_absent_commands(CLI::App& cli, std::vector<std::unique_ptr<Command>>& commands);
// Adds all subcommands, in the order of the help.
std::vector<std::unique_ptr<Command>> make_commands(CLI::App& cli);

}  // namespace psygen::cli
