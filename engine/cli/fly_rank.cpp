// psygen fly as one rank of a cluster: rank 0 flies, the others make meshes for it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/cli/fly_command.hpp"
#include "engine/cli/shipped_files.hpp"
#include "engine/cli/standard_streams.hpp"
#include "engine/cluster/agreement.hpp"
#include "engine/cluster/model_server.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/log.hpp"

namespace psygen::cli {
namespace {

// Returns true if mpirun, or srun --mpi=pmix and similar launchers, started this process as a rank.
bool was_started_as_rank() {
  return cluster::is_rank() || std::getenv("PMIX_RANK") != nullptr;
}

}  // namespace

std::string FlyCommand::validate_cluster_options() const {
  const char* const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (!in_cluster_ && ranks != nullptr && std::atoi(ranks) > 1)
    return fmt::format(
        "each of the {} MPI ranks would start its own flight; with --cluster, rank 0 flies and "
        "the others make its meshes",
        ranks);
  if (in_cluster_ && !was_started_as_rank())
    return "--cluster needs other ranks: mpirun -n 4 psygen fly --cluster";
  return {};
}

// Only rank 0 prints messages common to all ranks.
bool FlyCommand::prints_messages() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (rank == nullptr) rank = std::getenv("PMIX_RANK");
  return rank == nullptr || std::atoi(rank) == 0;
}

int FlyCommand::run_rank() {
  const auto peers = cluster::join_communicator();
  if (!peers) {
    core::log_error(peers.error().message);
    return exit_code_of(peers.error());
  }
  return run_rank(**peers);
}

// Errors of a rank are reported after the handshake, so that no rank waits. Only rank 0 needs a
// path.
int FlyCommand::run_rank(cluster::Peers& peers) {
  models::Registry registry = models::make_standard_registry();
  const auto key =
      (peers.rank() == 0 ? find_files() : find_world(options_.session))
          .and_then([&] { return load_world(options_.session.world_file.string(), registry); })
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

}  // namespace psygen::cli
