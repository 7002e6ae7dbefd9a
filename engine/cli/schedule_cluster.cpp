// psygen schedule --ranks: simulates a cluster that synthesises a world of this size, under the
// virtual clock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/cli/schedule_command.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/cluster/simulate.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::cli {
namespace {

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

int ScheduleCommand::simulate_cluster() const {
  const ClusterOptions& o = cluster_;
  Demand demand;
  const auto costs = costs_of(o.world, o.terabytes * 1e12, demand);
  if (!costs) {
    core::log_error(costs.error().message);
    return exit_code_of(costs.error());
  }
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
      amplify::LedgerSource::kMaxBlocks, static_cast<std::uint64_t>(per_thread / kRunsPerThread));
  cluster::PlanOptions options;
  if (o.share != "claims") options.fixed_share = 1;
  const amplify::CostMap planned = o.share == "count" ? amplify::CostMap::flat(demand.blocks)
                                                      : costs->plus(o.file_latency_ms * 1e-3);
  const cluster::Plan plan(amplify::BlockRanges({0, demand.blocks}), planned, o.ranks, options);
  const cluster::VirtualReport report = cluster::simulate(plan, job);
  return print(json_ ? json_of(o, demand, report) : text_of(o, demand, report));
}

}  // namespace psygen::cli
