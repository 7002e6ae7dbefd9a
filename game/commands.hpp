// The subcommands of psygen. Each declares its options when it is made and runs when it was chosen.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/app/app.hpp"
#include "engine/exchange/write_document.hpp"
#include "game/request_recorder.hpp"

namespace psygen::game {

enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

int exit_code_of(const core::Error& error);

// Writes data to stdout. kFailed when it does not get there, with a message unless its reader has
// closed the pipe.
int print(const std::string& text);

class FlyCommand {
 public:
  explicit FlyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  core::Result<void> load_what_pictures_take() const;
  int fly(app::App& app) const;
  core::Result<void> write_requests() const;

  CLI::App* command_;
  app::Options options_;
  std::string world_ = "game/worlds/paper.toml";
  std::string requests_;  // file; empty: they are not recorded
  RequestRecorder recorder_;
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

class AmplifyCommand {
 public:
  explicit AmplifyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  int print_heights(const world::World& world) const;
  core::Result<amplify::Report> amplify(const world::World& world,
                                        const models::Registry& registry);
  int print_report(const amplify::Report& report) const;

  CLI::App* command_;
  std::string world_ = "game/worlds/paper.toml";
  std::optional<amplify::Region> region_;
  unsigned threads_ = 0;
  std::vector<glm::dvec2> samples_;  // x and z in metres
  std::string out_;                  // empty: nothing is written
  std::string format_ = "glb";
  std::string simd_;                         // empty: the best
  std::uint64_t written_ = 0, skipped_ = 0;  // files
  bool json_ = false;
};

class ExportCommand {
 public:
  explicit ExportCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  core::Result<exchange::Document> model_document(const models::Registry& registry,
                                                  const world::Palette& palette) const;
  core::Result<exchange::Document> block_document(const world::World& world,
                                                  const models::Registry& registry) const;

  CLI::App* command_;
  std::string model_, world_ = "game/worlds/paper.toml", out_;
  std::vector<std::string> settings_;  // name=value
  std::optional<core::BlockCoord> block_;
  int level_ = 0;
};

class CalibrateCommand {
 public:
  explicit CalibrateCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string out_, world_ = "game/worlds/paper.toml";
  bool ranges_ = false;
  std::size_t samples_ = 64;
  bool json_ = false;
};

class ScheduleCommand {
 public:
  explicit ScheduleCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string file_;
  unsigned modelers_ = 2;
  double slower_ = 1;
  bool json_ = false;
};

}  // namespace psygen::game
