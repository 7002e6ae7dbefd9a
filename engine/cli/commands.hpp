// The subcommands of psygen. The constructor declares a command and its options, chosen() returns
// true if the command line named it, and run() runs it and returns the exit code. Main thread.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/app/flight.hpp"
#include "engine/cli/amplify_figures.hpp"
#include "engine/cli/request_recorder.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/cluster/remote_models.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/tiles/tile_tree.hpp"

namespace psygen::cli {

// Exit code of `psygen`.
enum ExitCode : int { kOk = 0, kFailed = 1, kUsage = 2, kNoDevice = 4 };

// kNoDevice for an error of that code, else kFailed.
inline int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}

// `psygen fly`.
class FlyCommand {
 public:
  explicit FlyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  void add_flight_options();
  void add_synthesis_options();
  void add_picture_options();
  void add_cluster_options();
  std::string objection() const;
  std::string cluster_objection() const;
  static bool is_heard();
  core::Result<void> find_files();
  int run_alone();
  int run_here();
  int run_rank();
  int run_rank(cluster::Peers& peers);
  int run_first_rank(cluster::FlightKey key, const std::vector<unsigned>& threads,
                     cluster::Peers& peers);
  void print_cluster() const;
  static int code_of(const core::Error& error);
  core::Result<void> load_what_pictures_take() const;
  int fly();
  int tell(const app::FlightReport& report) const;
  core::Result<void> write_requests() const;

  CLI::App* command_;
  app::FlightOptions options_;
  std::unique_ptr<app::Flight> flight_;
  int told_ = 0;          // exit code of writing the flight's outputs
  std::string requests_;  // file; empty: requests are not recorded
  RequestRecorder recorder_;
  bool inspect_ = false, json_ = false;
  bool in_cluster_ = false;
  cluster::RemoteOptions remote_options_;
  std::unique_ptr<cluster::RemoteModels> remote_;  // only on rank 0
};

// `psygen picture`.
class PictureCommand {
 public:
  explicit PictureCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  core::Result<void> take(app::Session& session) const;

  CLI::App* command_;
  app::SessionOptions options_;
  std::string out_;
  std::optional<glm::dvec2> at_;  // metres; none: the centre of the world
  double height_m_ = 1.7, yaw_deg_ = 0, pitch_deg_ = 0;
};

// `psygen models`.
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

// `psygen amplify`.
class AmplifyCommand {
 public:
  explicit AmplifyCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run();

 private:
  int print_heights(const world::World& world) const;
  core::Result<amplify::Region> region_of(const world::World& world) const;
  int run_rank();
  int run_rank(cluster::Peers& peers);
  core::Result<amplify::Report> amplify(const world::World& world,
                                        const models::Registry& registry);
  core::Result<amplify::Report> make_shard(amplify::Job job, const amplify::Region& region,
                                           amplify::JobFormat format,
                                           const amplify::Options& options) const;
  int print_report(const amplify::Report& report) const;
  int print_figures(const AmplifyFigures& figures, bool stopped) const;

  CLI::App* command_;
  std::string world_ = kDefaultWorld;
  std::optional<amplify::Region> region_;
  unsigned threads_ = 0;
  std::vector<glm::dvec2> samples_;  // x and z in metres
  std::string out_;                  // empty: write no files
  std::string format_ = "glb";
  std::optional<amplify::Shard> shard_;
  std::string simd_;                         // empty: the best
  std::uint64_t written_ = 0, skipped_ = 0;  // files
  bool mpi_ = false, json_ = false;
};

// `psygen export`.
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
  int export_region(const world::World& world, const models::Registry& registry) const;
  int export_heightmap(const world::World& world, unsigned threads) const;

  CLI::App* command_;
  std::string model_, world_ = kDefaultWorld, out_;
  std::vector<std::string> settings_;  // name=value
  std::optional<core::BlockCoord> block_;
  int level_ = 0;
  std::optional<amplify::Region> region_;
  std::string format_ = "3dtiles";  // of a region
  std::optional<tiles::NodeLevels> levels_;
  unsigned threads_ = 0;
};

// `psygen calibrate`.
class CalibrateCommand {
 public:
  explicit CalibrateCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string out_, world_ = kDefaultWorld;
  bool ranges_ = false;
  std::size_t samples_ = 64;
  bool json_ = false;
};

// Options of the job that `psygen schedule --ranks` simulates.
struct ClusterOptions {
  unsigned ranks = 0;  // 0: no cluster
  unsigned cores = 1, threads = 0;
  std::string world = kDefaultWorld;
  std::string share = "claims";
  double terabytes = 8;       // 10^12 bytes of files
  double error_percent = 20;  // largest error of predictions
  double latency_us = 2, claims_per_s = 1e6;
  double rank_gb_per_s = 25, storage_gb_per_s = 4600, files_per_s = 64000, file_latency_ms = 3;
};

// `psygen schedule`.
class ScheduleCommand {
 public:
  explicit ScheduleCommand(CLI::App& cli);
  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  int compare_policies() const;
  int simulate_cluster() const;

  CLI::App* command_;
  std::string file_;
  unsigned modelers_ = 2;
  double slower_ = 1;
  ClusterOptions cluster_;
  bool json_ = false;
};

}  // namespace psygen::cli
