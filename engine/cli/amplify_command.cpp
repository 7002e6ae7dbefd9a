// psygen amplify: synthesises a region or the whole world and prints its hash.
#include <fmt/format.h>

#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/block_files.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/cli/amplify_stats.hpp"
#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/text_values.hpp"
#include "engine/cluster/job.hpp"
#include "engine/cluster/meeting.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"
#include "engine/core/processors.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::cli {
namespace {

class AmplifyCommand final : public Command {
 public:
  explicit AmplifyCommand(CLI::App& cli);
  int run() override;

 private:
  int print_heights(const world::World& world) const;
  core::Result<amplify::Region> region_of(const world::World& world) const;
  int run_rank();
  core::Result<amplify::Report> amplify(const world::World& world,
                                        const models::Registry& registry);
  core::Result<amplify::Report> make_shard(amplify::Job job, const amplify::Region& region,
                                           amplify::JobFormat format,
                                           const amplify::Options& options) const;
  int print_figures(const AmplifyStats& figures) const;

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

// Only rank 0 prints errors common to all ranks.
int end_with(const core::Error& error, cluster::Peers& peers) {
  if (peers.rank() == 0) core::log_error(error.message);
  peers.finish();
  return exit_code_of(error);
}

}  // namespace

AmplifyCommand::AmplifyCommand(CLI::App& cli)
    : Command(cli, "amplify", "Synthesise a region or the whole world") {
  CLI::App& c = *command_;
  c.add_option("--world", world_, "World definition: a TOML file or the name of a shipped one")
      ->capture_default_str();
  auto* region = add_parsed(c, "--region", region_, amplify::parse_region, "REGION",
                            "Blocks X0,Z0,X1,Z1, excluding X1 and Z1; default: the whole world");
  c.add_option("--threads", threads_, "Threads; default: one per usable processor")
      ->transform(integer_between(1, amplify::kMaxThreads));
  c.add_option_function<std::vector<std::string>>(
       "--sample",
       [this](const std::vector<std::string>& texts) {
         for (const std::string& text : texts)
           samples_.push_back(*parse_place(text));
       },
       "Only print the height of the ground at X,Z (metres of the world); may be given "
       "several times")
      ->check(valid_if(parse_place, "X,Z"))
      ->excludes(region);
  auto* out =
      c.add_option("--out", out_, "Folder for one file per block; resumes an interrupted run");
  out->excludes("--sample");
  auto* shard = add_parsed(
      c, "--shard", shard_, amplify::parse_shard, "I/N",
      "Synthesise only shard I of N, of equal predicted cost, and write its ledger to --out");
  shard->needs(out);
  c.add_option("--format", format_,
               "File format in --out: glb or obj; none (with --shard): only the ledger")
      ->check(one_of({"glb", "obj", amplify::kNoFiles}))
      ->capture_default_str()
      ->needs(out);
  c.add_option("--simd", simd_,
               "Instruction set of the kernels, for comparisons; default: the best")
      ->check(one_of(models::simd_targets()));
  c.add_flag("--mpi", mpi_, "Run as one MPI rank (detected under mpirun)")
      ->excludes(shard)
      ->excludes("--sample");
  c.add_flag("--json", json_, "Print the results as JSON");
  c.callback([this] {
    if (format_ == amplify::kNoFiles && !shard_ && !mpi_ && !cluster::is_rank())
      throw CLI::ValidationError("psygen amplify: --format none needs --shard or --mpi");
  });
}

int AmplifyCommand::run() {
  if (!simd_.empty()) models::pin_simd_target(simd_);
  if (mpi_ || (cluster::is_rank() && !shard_ && samples_.empty())) return run_rank();
  if (const unsigned copies = cluster::copies_started(); copies > 1 && !shard_ && samples_.empty())
    return fail_with({core::ErrorCode::kInvalidArgument,
                      fmt::format("srun started {0} copies, and each would make the whole region; "
                                  "share it by MPI (mpirun -n {0} psygen amplify ..., or srun "
                                  "--mpi=pmix with --mpi), or by shards (--shard "
                                  "$((SLURM_PROCID + 1))/{0} in a script that srun starts)",
                                  copies)});
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world_and_files(world_, registry);
  if (!world) return fail_with(world.error());
  if (!samples_.empty()) return print_heights(*world);
  const auto report = amplify(*world, registry);
  if (!report) return fail_with(report.error());
  AmplifyStats figures;
  figures.report = *report;
  const bool with_files = !out_.empty() && format_ != amplify::kNoFiles;
  if (with_files) figures.files = {written_, skipped_};
  if (shard_) figures.part = amplify::text_of(*shard_);
  return print_figures(figures);
}

int AmplifyCommand::print_heights(const world::World& world) const {
  auto list = nlohmann::ordered_json::array();
  std::string text;
  for (const glm::dvec2& place : samples_) {
    const auto at = position_at(world, place);
    if (!at) return fail_with(at.error());
    const double height_m =
        models::ground_height_m(world.terrain, at->block, at->local.x, at->local.z);
    text += fmt::format("{}\n", height_m);  // the shortest text that reads back as the same number
    list.push_back({{"x_m", place.x}, {"z_m", place.y}, {"height_m", height_m}});
  }
  return print(json_ ? list.dump(2) + "\n" : text);
}

core::Result<amplify::Region> AmplifyCommand::region_of(const world::World& world) const {
  const auto region = region_ ? core::Result<amplify::Region>(*region_) : amplify::whole(world);
  if (!region) return region;
  if (auto ok = amplify::check_region(world, *region); !ok) return tl::unexpected(ok.error());
  return region;
}

core::Result<amplify::Report> AmplifyCommand::amplify(const world::World& world,
                                                      const models::Registry& registry) {
  const auto region = region_of(world);
  if (!region) return tl::unexpected(region.error());
  std::unique_ptr<amplify::BlockFolder> folder;
  amplify::Options options;
  const amplify::JobFormat format = exchange::format_from(format_);
  if (!out_.empty() && format) {
    auto opened = amplify::BlockFolder::open(out_, world, registry, *format);
    if (!opened) return tl::unexpected(opened.error());
    folder = std::move(*opened);
    options.make_sink = [&folder] { return folder->make_sink(); };
  }
  options.threads = threads_ > 0 ? threads_ : amplify::threads_for(core::usable_processors());
  options.stop = &stop_at_interrupt();
  telemetry::ProgressBar bar(telemetry::stderr_terminal(), "amplifying " + world.name,
                             static_cast<double>(region->block_count()));
  options.progress = [&bar](std::uint64_t blocks) { bar.update(static_cast<double>(blocks)); };
  auto report = shard_ ? make_shard({world, registry, {}}, *region, format, options)
                       : amplify::amplify(world, registry, *region, options);
  if (folder) {
    written_ = folder->written();
    skipped_ = folder->skipped();
  }
  return report;
}

core::Result<amplify::Report> AmplifyCommand::make_shard(amplify::Job job,
                                                         const amplify::Region& region,
                                                         amplify::JobFormat format,
                                                         const amplify::Options& options) const {
  if (auto ok = telemetry::create_output_folder(out_); !ok) return tl::unexpected(ok.error());
  auto key = amplify::job_key(job.world, job.registry, region, format, core::version());
  if (!key) return tl::unexpected(key.error());
  job.key = std::move(*key);
  return amplify::amplify_shard(job, *shard_, out_, options);
}

int AmplifyCommand::print_figures(const AmplifyStats& figures) const {
  const int printed = print(json_ ? json_of(figures) : text_of(figures));
  const amplify::Totals& totals = figures.report.totals;
  if (totals.failed > 0) {
    core::log_error(fmt::format("{} meshes failed{}; first error: {}", totals.failed,
                                figures.files ? " (no files for their blocks)" : "",
                                totals.first_failure));
  }
  if (figures.report.stopped)
    core::log_error(fmt::format("interrupted after {} blocks", totals.blocks));
  return figures.report.complete ? printed : kFailed;
}

// Runs as one rank of a cluster.
int AmplifyCommand::run_rank() {
  const auto joined = cluster::join_communicator();
  if (!joined) return fail_with(joined.error());
  cluster::Peers& peers = **joined;
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world_and_files(world_, registry, peers.rank() != 0);
  if (auto ok = cluster::agree(world, peers); !ok) return end_with(ok.error(), peers);
  const auto region = region_of(*world);
  if (auto ok = cluster::agree(region, peers); !ok) return end_with(ok.error(), peers);
  amplify::Options options;
  options.threads =
      threads_ > 0 ? threads_ : amplify::threads_for(cluster::threads_for_rank(peers));
  options.stop = &stop_at_interrupt();
  std::optional<telemetry::ProgressBar> bar;
  if (peers.rank() == 0) {
    bar.emplace(telemetry::stderr_terminal(), "amplifying " + world->name,
                static_cast<double>(region->block_count()) / peers.count());
    options.progress = [&bar](std::uint64_t blocks) { bar->update(static_cast<double>(blocks)); };
  }
  const amplify::JobFormat format = out_.empty() ? std::nullopt : exchange::format_from(format_);
  const auto key = amplify::job_key(*world, registry, *region, format, core::version());
  const auto job = cluster::amplify_together(*world, registry, key, out_, options, peers);
  if (!job && job.error().common) return end_with(job.error().error, peers);
  if (!job) {
    core::log_error(
        fmt::format("rank {} ({}): {}", peers.rank(), peers.host(), job.error().error.message));
    peers.abort();
    return kFailed;
  }
  if (job->report.stopped) {  // ranks 0 and 1 report it: one of them may have died
    if (peers.rank() < 2)
      core::log_error(
          fmt::format("rank {}: stopped after {} blocks, because a rank died or the job "
                      "was ended; run the same command to resume",
                      peers.rank(), job->report.totals.blocks));
    return kFailed;
  }
  peers.finish();
  if (peers.rank() != 0) return job->report.complete ? kOk : kFailed;
  AmplifyStats figures;
  figures.report = job->report;
  if (format) figures.files = {job->written, job->skipped};
  figures.ranks = peers.count();
  figures.messages = job->messages;
  return print_figures(figures);
}

std::unique_ptr<Command> make_amplify_command(CLI::App& cli) {
  return std::make_unique<AmplifyCommand>(cli);
}

}  // namespace psygen::cli
