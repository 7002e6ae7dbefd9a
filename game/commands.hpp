// The subcommands of psygen. Each declares its options when it is made and runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
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
  bool json_ = false;
};

class AmplifyCommand {
 public:
  explicit AmplifyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  int print_heights(const world::World& world) const;
  core::Result<amplify::Report> amplify(const world::World& world,
                                        const models::Registry& registry) const;
  int print_report(const amplify::Report& report) const;

  CLI::App* command_;
  std::string world_ = "game/worlds/paper.toml";
  std::optional<amplify::Region> region_;
  unsigned threads_ = 0;
  std::vector<glm::dvec2> samples_;  // x and z in metres
  bool json_ = false;
};

}  // namespace psygen::game
