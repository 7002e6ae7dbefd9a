// psygen fly: a flight through a world, in a window or headless, and its measurements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/app/flight.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/scene_options.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cluster/job.hpp"
#include "engine/cluster/meeting.hpp"
#include "engine/cluster/model_server.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/cluster/remote_modeler_pool.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/image/image_io.hpp"
#include "engine/inspect/inspect.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/synthesis/request_stream.hpp"
#include "engine/telemetry/output_file.hpp"

namespace psygen::cli {
namespace {

// Records each mesh of a flight when it is first wanted, for `psygen schedule`.
class RequestRecorder {
 public:
  // Call after each tick: records its wanted meshes. Times are those of the flight.
  void observe(const scene::Scene& scene) {
    const double now_s = std::max(scene.clock().now_s, 0.0);
    for (const synthesis::Want& want : scene.meshes().wants()) {
      if (!seen_.insert(want.key).second) continue;
      const bool visible = synthesis::is_visible(want.rank.group());
      const double ahead_s = visible ? 0.0 : double{want.deadline_s};
      const bool due = visible || std::isfinite(want.deadline_s);
      jobs_.push_back({now_s, scene.meshes().predict(want),
                       due ? now_s + ahead_s : synthesis::kNoDeadline, want.rank});
    }
  }
  const std::vector<synthesis::SimulatedJob>& jobs() const { return jobs_; }

 private:
  std::unordered_set<synthesis::MeshKey> seen_;
  std::vector<synthesis::SimulatedJob> jobs_;
};

class FlyCommand final : public Command {
 public:
  explicit FlyCommand(CLI::App& cli);
  int run() override;

 private:
  void add_flight_options();
  void add_synthesis_options();
  void add_picture_options();
  void add_cluster_options();
  std::string objection() const;
  std::string validate_cluster_options() const;
  core::Result<void> find_files();
  int run_alone();
  int run_here();
  int run_rank();
  int run_first_rank(cluster::CompatibilityKey key, const std::vector<unsigned>& threads,
                     cluster::Peers& peers);
  void print_cluster() const;
  int fly();
  int tell(const app::FlightReport& report) const;
  core::Result<void> write_requests() const;

  app::FlightOptions options_;
  std::unique_ptr<app::Flight> flight_;
  int told_ = 0;          // exit code of writing the flight's outputs
  std::string requests_;  // file; empty: requests are not recorded
  RequestRecorder recorder_;
  bool inspect_ = false, json_ = false;
  bool in_cluster_ = false;
  cluster::RemoteOptions remote_options_;
  std::unique_ptr<cluster::RemoteModelerPool> remote_;  // only on rank 0
};

// Returns true if mpirun, or srun --mpi=pmix and similar launchers, started this process as a rank.
bool was_started_as_rank() {
  return cluster::is_rank() || std::getenv("PMIX_RANK") != nullptr;
}

// Only rank 0 prints messages common to all ranks.
bool prints_messages() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (rank == nullptr) rank = std::getenv("PMIX_RANK");
  return rank == nullptr || std::atoi(rank) == 0;
}

// Closing the window before the flight begins is not a failure.
int code_of(const core::Error& error) {
  if (error.code == core::ErrorCode::kInterrupted) {
    core::log_info(error.message);
    return kOk;
  }
  return fail_with(error);
}

}  // namespace

FlyCommand::FlyCommand(CLI::App& cli)
    : Command(cli, "fly", "Fly through a world, in a window or headless") {
  add_scene_options(*command_, options_.session);
  add_flight_options();
  add_synthesis_options();
  add_picture_options();
  add_cluster_options();
  command_->add_option("--record-requests", requests_,
                       "Record all mesh requests in this file; starts with an empty cache");
  command_->add_flag("--inspect", inspect_,
                     "Let programs of this user inspect and change the flight over a socket in "
                     "$XDG_RUNTIME_DIR");
  command_->add_flag("--json", json_, "Print the summary as JSON instead of a table");
}

void FlyCommand::add_flight_options() {
  CLI::App& c = *command_;
  c.add_option(
      "--path", options_.path_file,
      "Camera path: a TOML file or the name of a shipped one; default: the camera turns in "
      "place, or you fly in the window");
  c.add_option("--out", options_.out_folder,
               "Folder for frames.csv, summary.json, trace.json, report.html and images");
  c.add_flag("--headless", options_.session.headless, "Open no window; needs no display");
  c.add_option("--seconds", options_.seconds, "Length of the flight; 0: length of the path")
      ->check(number_between(0, 86400));
  c.add_flag("--loop", options_.loop,
             "Repeat the path until --seconds (27 if headless) have passed")
      ->needs("--path");
  c.add_option("--frames", options_.frames, "End after this many frames; 0: no limit")
      ->transform(integer_between(0, 1'000'000'000));
  c.add_option("--fixed-step", options_.fixed_step_hz,
               "Advance the flight by 1/HZ seconds per frame, whatever its real time")
      ->check(number_between(1, 1000));
  c.add_option_function<std::string>(
       "--clock",
       [this](const std::string& text) { options_.session.scene.virtual_time = text == "virtual"; },
       "Clock: wall, or virtual (fixed costs, identical on every machine; headless only)")
      ->check(CLI::IsMember({"wall", "virtual"}))
      ->default_str("wall");
  c.add_option("--warmup", options_.warmup_seconds, "Seconds at the start that statistics exclude")
      ->capture_default_str()
      ->check(number_between(0, 3600));
  c.add_option("--images", options_.images_every, "Write every Nth frame as a PNG")
      ->transform(integer_between(0, 1'000'000'000));
}

void FlyCommand::add_synthesis_options() {
  CLI::App& c = *command_;
  scene::SceneSettings& scene = options_.session.scene;
  add_parsed(
      c, "--paradigm", scene.paradigm, scene::paradigm_from, "pla|amplify|lazy",
      "pla: on demand, in parallel; amplify: all meshes first; lazy: all meshes in each frame")
      ->default_str("pla");
  c.add_option_function<std::string>(
       "--policy",
       [&scene](const std::string& text) { scene.policy = *synthesis::policy_from(text); },
       "Order of synthesis: fifo, plp, shortest, longest, deadline")
      ->check(one_of({"fifo", "plp", "shortest", "longest", "deadline"}))
      ->default_str("deadline");
  c.add_option_function<std::string>(
       "--modeler-priority",
       [&scene](const std::string& text) { scene.modelers_yield = text == "lowest"; },
       "Priority of modelers: lowest, or normal, to measure their effect on frames")
      ->check(one_of({"lowest", "normal"}))
      ->default_str("lowest");
  add_parsed(c, "--plp", scene.plp_mode, scene::plp_mode_from, "layers|solidity",
             "Order of nodes: layers around the camera, or solidity (least hidden first)")
      ->default_str("layers");
}

void FlyCommand::add_picture_options() {
  CLI::App& c = *command_;
  scene::SceneSettings& scene = options_.session.scene;
  c.add_option_function<double>(
       "--target-fps", [this](double hz) { options_.session.target_hz = hz; },
       "Hold this frame rate by a lower resolution, then by a larger error (up to 4 times); 0: "
       "fixed "
       "error")
      ->default_str("60 in a window, 0 headless")
      ->check(zero_or_between(0.1, 1000));
  c.add_option("--min-resolution", scene.min_resolution,
               "Lowest render scale of the landscape used to hold the frame rate, as a fraction of "
               "width and height; 1: always full resolution")
      ->capture_default_str()
      ->check(number_between(0.25, 1));
  c.add_option("--fade", scene.fade_seconds, "Seconds for models to fade in and out; 0: no fade")
      ->capture_default_str()
      ->check(number_between(0, 60));
  c.add_flag("!--no-vsync", options_.session.vsync, "Do not wait for the display's vertical sync");
  c.add_flag("--fullscreen", options_.session.fullscreen, "Start in full screen");
  c.add_flag("!--no-prefill", options_.session.prefill, "Start with an empty cache");
}

void FlyCommand::add_cluster_options() {
  auto* cluster =
      command_->add_flag("--cluster", in_cluster_,
                         "Under mpirun: rank 0 flies, and the others make its costly meshes");
  command_
      ->add_option_function<double>(
          "--send-above", [this](double ms) { remote_options_.send_above_s = ms * 1e-3; },
          "Offload meshes predicted to take longer than this (ms); default: the measured round "
          "trip")
      ->check(number_between(0, 1e6))
      ->needs(cluster);
}

// Returns the reason why the options are invalid together, or on this machine; empty if they are
// valid.
std::string FlyCommand::objection() const {
  const bool is_virtual = options_.session.scene.virtual_time;
  if (is_virtual && !options_.session.headless)
    return "--clock virtual needs --headless: a window follows the wall clock";
  if (is_virtual && in_cluster_)
    return "--cluster needs --clock wall: the times of other ranks are not fixed";
  return validate_cluster_options();
}

int FlyCommand::run() {
  if (const std::string reason = objection(); !reason.empty()) {
    if (!prints_messages()) return kOk;  // mpirun ends all ranks when the first one fails
    core::log_error(reason);
    return kUsage;
  }
  const int code = in_cluster_ ? run_rank() : run_alone();
  // The hung modeler still uses the session's memory, so the destructors must not run.
  if (flight_ && flight_->session().has_hung_modelers()) std::_Exit(code);
  flight_.reset();
  return code;
}

core::Result<void> FlyCommand::find_files() {
  return find_world(options_.session).and_then([this] { return find_path(options_); });
}

int FlyCommand::run_alone() {
  if (auto ok = find_files(); !ok) return fail_with(ok.error());
  return run_here();
}

int FlyCommand::run_here() {
  options_.session.stop = &stop_at_interrupt();
  if (inspect_) options_.session.plugins.push_back(inspect::plugin());
  app::Plugin reporter;
  reporter.name = "report";
  if (!requests_.empty()) {
    options_.session.prefill = false;  // the initial fill is a part of the recording
    const std::filesystem::path inputs[] = {options_.session.world_file, options_.path_file};
    const auto writable = telemetry::check_no_input(requests_, inputs).and_then([this] {
      return telemetry::check_output_file(requests_);
    });
    if (!writable) return code_of(writable.error());
    reporter.on_frame = [this](app::Session& session, double) {
      if (flight_->is_recorded()) recorder_.observe(session.scene());
    };
  }
  // Runs at the end of the flight, not only when its window closes.
  reporter.on_end = [this](app::Session&, const app::FlightReport& report) {
    told_ = tell(report);
  };
  options_.session.plugins.push_back(std::move(reporter));
  // Before the driver and the modelers use up the available threads.
  const auto codec =
      options_.images_every > 0 ? image::load_picture_libraries() : core::Result<void>{};
  auto flight = codec.and_then([this] { return app::Flight::create(options_); });
  if (!flight) return code_of(flight.error());
  flight_ = std::move(*flight);
  return fly();
}

int FlyCommand::fly() {
  const auto report = flight_->run();
  if (!report) {
    if (auto ok = write_requests(); !ok) core::log_error(ok.error().message);
    return code_of(report.error());
  }
  for (const std::string& message : report->validation_messages)
    core::log_error(message);
  return report->validation_messages.empty() ? told_ : kFailed;
}

int FlyCommand::tell(const app::FlightReport& report) const {
  int code = print(json_ ? telemetry::to_json(report.summary) : telemetry::to_text(report.summary));
  if (remote_) print_cluster();
  for (const auto& file : report.files)
    core::log_info(fmt::format("wrote {}", file.string()));
  const auto fail = [&code](const std::string& sentence) {
    core::log_error(sentence);
    code = kFailed;
  };
  for (const core::Error& failure : report.failures)
    fail(failure.message);
  if (auto ok = write_requests(); !ok) fail(ok.error().message);
  return code;
}

// Writes the recorded requests, if requested.
core::Result<void> FlyCommand::write_requests() const {
  if (requests_.empty()) return {};
  auto written = core::replace_file(requests_, synthesis::stream_text(recorder_.jobs()));
  if (written) core::log_info(fmt::format("wrote {}", requests_));
  return written;
}

std::string FlyCommand::validate_cluster_options() const {
  if (const unsigned copies = cluster::copies_started(); !in_cluster_ && copies > 1)
    return fmt::format(
        "each of the {} processes would start its own flight; with mpirun and --cluster, rank 0 "
        "flies and the others make its meshes",
        copies);
  if (in_cluster_ && !was_started_as_rank())
    return "--cluster needs other ranks: mpirun -n 4 psygen fly --cluster";
  return {};
}

// Errors of a rank are reported after the handshake, so that no rank waits. Only rank 0 needs a
// path.
int FlyCommand::run_rank() {
  const auto joined = cluster::join_communicator();
  if (!joined) return fail_with(joined.error());
  cluster::Peers& peers = **joined;
  models::Registry registry = models::make_standard_registry();
  const std::filesystem::path& file = options_.session.world_file;  // the session logs its warnings
  const auto key = (peers.rank() == 0 ? find_files() : find_world(options_.session))
                       .and_then([&] { return load_world(file.string(), registry, true); })
                       .map([&](const world::World& world) {
                         return cluster::compatibility_key(world, registry, core::version());
                       });
  const std::uint32_t asked = options_.session.scene.modelers;
  const unsigned threads = asked > 0 ? asked : cluster::threads_for_rank(peers);
  const auto all = cluster::meet(key, threads, peers);
  if (!all) {
    if (peers.rank() == 0) core::log_error(all.error().message);
    peers.finish();
    return exit_code_of(all.error());
  }
  if (peers.rank() == 0) return run_first_rank(*key, *all, peers);
  const auto served = cluster::run_model_server(registry, threads, peers);
  if (!served) {
    core::log_error(fmt::format("rank {}: {}", peers.rank(), served.error().message));
    peers.abort();
    return kFailed;
  }
  peers.finish();
  if (served->hangs) std::_Exit(kOk);
  return kOk;
}

// The flight reserves a processor for its frames. It ends before the other ranks are told to.
int FlyCommand::run_first_rank(cluster::CompatibilityKey key, const std::vector<unsigned>& threads,
                               cluster::Peers& peers) {
  std::uint32_t& modelers = options_.session.scene.modelers;
  if (modelers == 0) modelers = std::max(cluster::threads_for_rank(peers), 2U) - 1;
  auto remote = cluster::RemoteModelerPool::start(std::move(key), threads, peers, remote_options_);
  if (!remote) {
    core::log_error(remote.error().message);
    peers.abort();
    return kFailed;
  }
  remote_ = std::move(*remote);
  options_.session.remote = remote_.get();
  const int code = run_here();
  if (flight_ && !flight_->session().has_hung_modelers()) flight_.reset();
  if (remote_->end()) {
    peers.finish();
  } else {
    peers.abort();
  }
  return code;
}

// Printed below the table of the flight; with --json, logged as messages.
void FlyCommand::print_cluster() const {
  const cluster::RemoteStats figures = remote_->figures();
  std::string_view title = "cluster";
  const auto row = [&](std::string_view label, const std::string& value) {
    const std::string line = fmt::format("{:<10} {:<18} {}", title, label, value);
    title = "";
    json_ ? core::log_info(line) : static_cast<void>(print(line + "\n"));
  };
  row("other ranks", figures.lost == 0
                         ? fmt::format("{}", figures.ranks)
                         : fmt::format("{}, {} of them lost", figures.ranks, figures.lost));
  row("remote meshes", fmt::format("{} meshes, {:.1f} MB", figures.meshes,
                                   static_cast<double>(figures.bytes) * 1e-6));
  if (figures.given_back > 0) row("returned", fmt::format("{} requests", figures.given_back));
  row("round trip", fmt::format("{:.0f} µs for a mesh of 100 KB", figures.way.seconds(1e5) * 1e6));
}

std::unique_ptr<Command> make_fly_command(CLI::App& cli) {
  return std::make_unique<FlyCommand>(cli);
}

}  // namespace psygen::cli
