// psygen schedule: simulates each policy on a recorded stream of requests, under the virtual clock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/cli/commands.hpp"
#include "engine/cli/option_checks.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cluster/simulate.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/synthesis/request_stream.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::cli {
namespace {

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

class ScheduleCommand final : public Command {
 public:
  explicit ScheduleCommand(CLI::App& cli);
  int run() override;

 private:
  int compare_policies() const;
  int simulate_cluster() const;

  std::string file_;
  unsigned modelers_ = 2;
  double slower_ = 1;
  ClusterOptions cluster_;
  bool json_ = false;
};

constexpr double kOverloadPercent = 100;

core::Result<std::vector<synthesis::SimulatedJob>> read_stream(const std::string& file) {
  const auto text = world::read_text_file(file, synthesis::kMaxStreamBytes);
  if (!text) return tl::unexpected(text.error());
  return synthesis::parse_stream(*text, file);
}

constexpr const char* kColumns =
    "fill      time to finish the requests of the first frame alone, and the fraction of it in\n"
    "          which modelers were idle\n"
    "visible   time from wanted in view to finished: how long a hole or a coarse model is visible\n"
    "late      fraction of the predicted requests that missed their deadline\n"
    "lateness  lateness of those requests, 0 if in time: mean and maximum\n"
    "deadline, the default, minimises the maximum lateness. If not all requests can be in time,\n"
    "shortest may be late less often and less on average, but delays some requests much longer.";

std::string table_of(std::span<const synthesis::PolicyStats> rows,
                     const synthesis::StreamLoad& load, unsigned modelers) {
  std::string text = fmt::format(
      "{} requests in {:.2f} s, {:.3g} s of work: {:.3g} % of the capacity of {} modeler{}\n",
      load.requests, load.span_s, load.work_s, load.percent, modelers, modelers == 1 ? "" : "s");
  if (load.percent > kOverloadPercent)
    text += "The modelers are overloaded: some requests have to wait under any policy.\n";
  text +=
      "           fill    idle   visible p50       p99       max    late  lateness       max\n"
      "             ms       %            ms        ms        ms       %        ms        ms\n";
  for (const synthesis::PolicyStats& row : rows) {
    fmt::format_to(
        std::back_inserter(text),
        "{:<8} {:>6.1f} {:>7.2f} {:>13.3f} {:>9.3f} {:>9.3f} {:>7.2f} {:>9.3f} {:>9.3f}\n",
        synthesis::name_of(row.policy), row.fill_s * 1e3, row.fill_idle_percent,
        row.visible_p50_s * 1e3, row.visible_p99_s * 1e3, row.visible_max_s * 1e3, row.late_percent,
        row.lateness_mean_s * 1e3, row.lateness_max_s * 1e3);
  }
  return text + "\n" + kColumns + "\n";
}

std::string json_of(std::span<const synthesis::PolicyStats> rows) {
  auto list = nlohmann::ordered_json::array();
  for (const synthesis::PolicyStats& row : rows) {
    list.push_back(
        {{"policy", synthesis::name_of(row.policy)},
         {"fill_seconds", row.fill_s},
         {"visible_seconds",
          {{"p50", row.visible_p50_s}, {"p99", row.visible_p99_s}, {"max", row.visible_max_s}}},
         {"late_percent", row.late_percent},
         {"lateness_seconds", {{"mean", row.lateness_mean_s}, {"max", row.lateness_max_s}}},
         {"fill_idle_percent", row.fill_idle_percent}});
  }
  return list.dump(2) + "\n";
}

CLI::Option* add_cluster_options(CLI::App& c, ClusterOptions& o) {
  auto* ranks = c.add_option("--ranks", o.ranks, "Simulate psygen amplify on this many ranks");
  ranks->transform(integer_between(1, 65536));
  const auto number = [&](const char* name, double& value, double low, double high,
                          const char* meaning) {
    c.add_option(name, value, meaning)
        ->capture_default_str()
        ->check(number_between(low, high))
        ->needs(ranks);
  };
  c.add_option("--world", o.world, "World whose block costs are used")
      ->capture_default_str()
      ->needs(ranks);
  c.add_option("--cores", o.cores, "Cores of each rank")
      ->capture_default_str()
      ->transform(integer_between(1, 1024))
      ->needs(ranks);
  c.add_option("--threads", o.threads, "Threads of each rank; default: one per core")
      ->transform(integer_between(1, 4096))
      ->needs(ranks);
  c.add_option("--share", o.share,
               "Distribution of blocks: by count, by predicted cost, or by cost with claims")
      ->check(one_of({"count", "cost", "claims"}))
      ->capture_default_str()
      ->needs(ranks);
  number("--terabytes", o.terabytes, 1e-3, 1e9,
         "Total size of all files, in 10^12 bytes; 0.001: 1 GB");
  number("--error-percent", o.error_percent, 0, 100,
         "Largest error of the predicted time of a run of blocks");
  number("--latency-us", o.latency_us, 0, 1e6, "Latency of a claim at rank 0");
  number("--claims-per-s", o.claims_per_s, 1, 1e12, "Claims per second that rank 0 can answer");
  number("--rank-gb-per-s", o.rank_gb_per_s, 1e-6, 1e9, "Bandwidth from a rank to the file system");
  number("--storage-gb-per-s", o.storage_gb_per_s, 1e-6, 1e9,
         "Bandwidth of the file system, for all ranks");
  number("--files-per-s", o.files_per_s, 1e-3, 1e12,
         "Files per second that the file system creates");
  number("--file-latency-ms", o.file_latency_ms, 0, 1e5, "Latency of writing a file to disk");
  return ranks;
}

constexpr double kHour = 3600;
// Blocks whose cost is predicted; for endless worlds, a square with this many blocks a side.
constexpr std::int64_t kEndlessBlocks = 512;
// Lower limit of the mean number of runs per thread, high enough that the size of a run has no
// effect.
constexpr double kRunsPerThread = 500;

// The work of a job, and its demands on the machines per second of a working core.
struct Demand {
  std::uint64_t blocks = 0;
  double block_bytes = 0;
  double core_seconds = 0;
};

struct Limit {
  const char* name;
  double busy;   // fraction of the makespan
  double ranks;  // number of ranks at which it would be busy all the time
};

std::vector<Limit> limits_of(const ClusterOptions& o, const Demand& demand,
                             const cluster::VirtualReport& report) {
  const double bytes = demand.block_bytes * static_cast<double>(demand.blocks);
  const double per_rank_s = demand.core_seconds / o.cores;  // if one rank did all the work
  const double claims_each = static_cast<double>(report.claims) / o.ranks;
  return {{"storage bandwidth", report.storage_busy, o.storage_gb_per_s * 1e9 * per_rank_s / bytes},
          {"metadata (files created)", report.metadata_busy,
           o.files_per_s * per_rank_s / static_cast<double>(demand.blocks)},
          {"claims at rank 0", report.claims_busy,
           claims_each > 0 ? std::sqrt(o.claims_per_s * per_rank_s / claims_each) : INFINITY},
          {"network of a rank", report.link_busy, INFINITY}};
}

std::string text_of(const ClusterOptions& o, const Demand& demand,
                    const cluster::VirtualReport& report) {
  const double bytes = demand.block_bytes * static_cast<double>(demand.blocks);
  std::string text;
  const auto row = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("{:<28} {}\n", name, value);
  };
  row("blocks", fmt::format("{}", demand.blocks));
  row("bytes", telemetry::size_text(bytes));
  row("ranks", fmt::format("{} of {} core{}", o.ranks, o.cores, o.cores == 1 ? "" : "s"));
  row("core-hours", fmt::format("{:.4g}", report.core_seconds / kHour));
  row("makespan", fmt::format("{:.4g} s ({:.3g} h)", report.makespan_s, report.makespan_s / kHour));
  row("efficiency", fmt::format("{:.2f} %", 100 * report.efficiency));
  row("idlest rank", fmt::format("{:.2f} %", 100 * report.worst_rank_idle));
  row("claims per block", fmt::format("{:.3g}", static_cast<double>(report.claims) /
                                                    static_cast<double>(demand.blocks)));
  for (const Limit& limit : limits_of(o, demand, report))
    row(limit.name, std::isfinite(limit.ranks)
                        ? fmt::format("{:.2f} % busy, saturated from {:.3g} ranks on",
                                      100 * limit.busy, limit.ranks)
                        : fmt::format("{:.2f} % busy", 100 * limit.busy));
  return text;
}

std::string json_of(const ClusterOptions& o, const Demand& demand,
                    const cluster::VirtualReport& report) {
  nlohmann::ordered_json json;
  json["blocks"] = demand.blocks;
  json["bytes"] = demand.block_bytes * static_cast<double>(demand.blocks);
  json["ranks"] = o.ranks;
  json["cores"] = o.cores;
  json["core_hours"] = report.core_seconds / kHour;
  json["makespan_seconds"] = report.makespan_s;
  json["efficiency"] = report.efficiency;
  json["worst_rank_idle"] = report.worst_rank_idle;
  json["claims"] = report.claims;
  json["rank_end_seconds"] = report.rank_end_s;
  for (const Limit& limit : limits_of(o, demand, report)) {
    json["limits"][limit.name]["busy"] = limit.busy;
    json["limits"][limit.name]["ranks"] = nullptr;
    if (std::isfinite(limit.ranks)) json["limits"][limit.name]["ranks"] = limit.ranks;
  }
  return json.dump(2) + "\n";
}

// Predicted costs of a world's blocks, repeated over a region of any size.
core::Result<amplify::CostMap> costs_of(const std::string& name, double bytes, Demand& demand) {
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world(name, registry);
  if (!world) return tl::unexpected(world.error());
  const amplify::Region region = world->is_endless()
                                     ? amplify::Region{0, 0, kEndlessBlocks, kEndlessBlocks}
                                     : amplify::Region{0, 0, world->blocks_x, world->blocks_z};
  std::vector<double> prices =
      amplify::prices_of(*world, registry, region, {amplify::kGlbSecondsPerTriangle, 0}, 0,
                         amplify::sample_count(region));
  demand.block_bytes =
      world::world_size(*world, registry).block_triangles * amplify::kGlbBytesPerTriangle;
  demand.blocks = std::max<std::uint64_t>(prices.size(),
                                          static_cast<std::uint64_t>(bytes / demand.block_bytes));
  return amplify::CostMap::from(demand.blocks, std::move(prices));
}

}  // namespace

ScheduleCommand::ScheduleCommand(CLI::App& cli)
    : Command(cli, "schedule", "Compare scheduling policies on recorded requests") {
  CLI::App& c = *command_;
  auto* requests =
      c.add_option("--requests", file_, "File written by `psygen fly --record-requests`");
  c.add_option("--modelers", modelers_, "Simulated modelers")
      ->capture_default_str()
      ->transform(integer_between(1, 256));
  c.add_option("--slower", slower_, "Multiply the time of every synthesis")
      ->capture_default_str()
      ->check(number_between(0.001, 1e6));
  add_cluster_options(c, cluster_)->excludes(requests);
  c.add_flag("--json", json_, "Print the results as JSON");
  c.callback([this] {
    if (file_.empty() && cluster_.ranks == 0)
      throw CLI::RequiredError("psygen schedule: one of --requests and --ranks");
  });
  c.footer(std::string("Columns:\n") + kColumns);
}

int ScheduleCommand::run() {
  return cluster_.ranks > 0 ? simulate_cluster() : compare_policies();
}

int ScheduleCommand::compare_policies() const {
  auto jobs = read_stream(file_);
  if (!jobs) return fail_with(jobs.error());
  for (synthesis::SimulatedJob& job : *jobs)
    job.seconds *= slower_;
  const auto rows = synthesis::compare_policies(*jobs, modelers_);
  return print(json_ ? json_of(rows)
                     : table_of(rows, synthesis::load_of(*jobs, modelers_), modelers_));
}

int ScheduleCommand::simulate_cluster() const {
  const ClusterOptions& o = cluster_;
  Demand demand;
  const auto costs = costs_of(o.world, o.terabytes * 1e12, demand);
  if (!costs) return fail_with(costs.error());
  demand.core_seconds = costs->total_s();
  cluster::VirtualJob job;
  job.ranks = o.ranks;
  job.cores = o.cores;
  job.threads = o.threads > 0 ? o.threads : o.cores;
  job.seconds_of = [&](const amplify::BlockRun& run) {
    const double random = static_cast<double>(core::mix64(run.first) >> 11) * 0x1p-53;
    const double factor = 1 + o.error_percent / 100 * (2 * random - 1);
    return factor * (costs->seconds_before(run.end) - costs->seconds_before(run.first));
  };
  job.bytes_of = [&](const amplify::BlockRun& run) {
    return demand.block_bytes * static_cast<double>(run.count());
  };
  job.limits = {o.latency_us * 1e-6,      o.claims_per_s, o.rank_gb_per_s * 1e9,
                o.storage_gb_per_s * 1e9, o.files_per_s,  o.file_latency_ms * 1e-3};
  const double per_thread = static_cast<double>(demand.blocks) / o.ranks / job.threads;
  job.max_blocks_per_run = std::max<std::uint64_t>(
      amplify::kMaxRun, static_cast<std::uint64_t>(per_thread / kRunsPerThread));
  cluster::PlanOptions options;
  if (o.share != "claims") options.fixed_share = 1;
  const amplify::CostMap planned = o.share == "count" ? amplify::CostMap::flat(demand.blocks)
                                                      : costs->plus(o.file_latency_ms * 1e-3);
  const cluster::Plan plan(amplify::BlockRanges({0, demand.blocks}), planned, o.ranks, options);
  const cluster::VirtualReport report = cluster::simulate(plan, job);
  return print(json_ ? json_of(o, demand, report) : text_of(o, demand, report));
}

std::unique_ptr<Command> make_schedule_command(CLI::App& cli) {
  return std::make_unique<ScheduleCommand>(cli);
}

}  // namespace psygen::cli
