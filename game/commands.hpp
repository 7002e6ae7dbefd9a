// The subcommands of psygen. Each declares its options when it is made and runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "engine/app/app.hpp"

namespace psygen::game {

enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

int exit_code_of(const core::Error& error);

// Writes data to stdout. kFailed, with a message, when it does not get there.
int print(const std::string& text);

class FlyCommand {
 public:
  explicit FlyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  int fly(app::App& app) const;

  CLI::App* command_;
  app::Options options_;
  std::string world_ = "game/worlds/paper.toml";
  bool json_ = false;
};

class ModelsCommand {
 public:
  explicit ModelsCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string world_;
  bool json_ = false;
};

}  // namespace psygen::game
