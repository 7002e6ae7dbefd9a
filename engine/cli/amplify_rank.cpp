// psygen amplify as one rank of a cluster.
#include <fmt/format.h>

#include "engine/cli/amplify_command.hpp"
#include "engine/cli/amplify_stats.hpp"
#include "engine/cli/interrupt.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cluster/agreement.hpp"
#include "engine/cluster/job.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::cli {
namespace {

// Only rank 0 prints errors common to all ranks.
int end_with(const core::Error& error, cluster::Peers& peers) {
  if (peers.rank() == 0) core::log_error(error.message);
  peers.finish();
  return exit_code_of(error);
}

}  // namespace

int AmplifyCommand::run_rank() {
  const auto peers = cluster::join_communicator();
  if (!peers) {
    core::log_error(peers.error().message);
    return exit_code_of(peers.error());
  }
  return run_rank(**peers);
}

int AmplifyCommand::run_rank(cluster::Peers& peers) {
  models::Registry registry = models::make_standard_registry();
  const auto world = load_world_and_files(world_, registry);
  core::Result<void> loaded{};
  if (!world) loaded = tl::unexpected(world.error());
  if (auto ok = cluster::agree(loaded, peers); !ok) return end_with(ok.error(), peers);
  const auto region = region_of(*world);
  if (!region) loaded = tl::unexpected(region.error());
  if (auto ok = cluster::agree(loaded, peers); !ok) return end_with(ok.error(), peers);
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
  AmplifyStats figures{job->report.totals, job->report.complete, {}, {}, {}, 0, 0, 0};
  figures.times = {job->report.seconds, job->report.cpu_seconds, job->report.threads};
  if (format) figures.files = {job->written, job->skipped};
  figures.ranks = peers.count();
  figures.messages = job->messages;
  return print_figures(figures, false);
}

}  // namespace psygen::cli
