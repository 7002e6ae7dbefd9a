#include "engine/cluster/simulate.hpp"

#include <algorithm>
#include <queue>
#include <utility>

#include "engine/amplify/amplify.hpp"
#include "engine/core/assert.hpp"

namespace psygen::cluster {
namespace {

using amplify::BlockRanges;
using amplify::BlockRun;

// Serves requests one after the other, in the order of their arrival.
struct Server {
  double free_s = 0, busy_s = 0;
  double serve(double at_s, double seconds) {
    free_s = std::max(free_s, at_s) + seconds;
    busy_s += seconds;
    return free_s;
  }
};

struct Rank {
  BlockRanges blocks;
  std::uint64_t position = 0;
  double ready_s = 0;  // when the chunk claimed last arrives
  bool is_over = false;
  std::vector<double> cores_free_s;
  Server link;
};

// A thread, which writes each run as soon as it is synthesised.
struct Thread {
  double free_s = 0;
  unsigned rank = 0;
  double bytes = 0;
  std::uint64_t files = 0;
  friend bool operator>(const Thread& a, const Thread& b) {
    return std::pair(a.free_s, a.rank) > std::pair(b.free_s, b.rank);
  }
};

class Simulation {
 public:
  Simulation(const Plan& plan, const VirtualJob& job) : plan_(plan), job_(job), ranks_(job.ranks) {
    for (unsigned rank = 0; rank < job.ranks; ++rank) {
      ranks_[rank].blocks = plan.own(rank);
      ranks_[rank].cores_free_s.resize(job.cores > 0 ? job.cores : job.threads);
      for (unsigned i = 0; i < job.threads; ++i)
        threads_.push({0, rank});
    }
    report_.rank_busy_s.resize(job.ranks);
    report_.rank_end_s.resize(job.ranks);
  }

  // Processes the next event until none is left. Servers receive requests in the order of time.
  VirtualReport run() {
    while (!threads_.empty()) {
      Thread thread = threads_.top();
      threads_.pop();
      if (thread.files > 0) {
        write(thread);
      } else if (fetch(thread)) {
        make(thread);
      } else {
        continue;
      }
      report_.rank_end_s[thread.rank] = std::max(report_.rank_end_s[thread.rank], thread.free_s);
      threads_.push(thread);
    }
    return finish();
  }

 private:
  // Ensures that the thread's rank has blocks. Returns false if none are left.
  bool fetch(Thread& thread) {
    Rank& rank = ranks_[thread.rank];
    while (rank.position == rank.blocks.count()) {
      if (rank.is_over || plan_.chunk_count() == 0) return false;
      const MachineLimits& limits = job_.limits;
      const double asked_s = std::max(thread.free_s, rank.ready_s);
      rank.ready_s = claims_.serve(asked_s, 1 / limits.claims_per_second) + limits.claim_latency_s;
      const std::uint64_t chunk = report_.claims++;
      rank.is_over = chunk >= plan_.chunk_count();
      if (rank.is_over) return false;
      rank.blocks = plan_.chunk(chunk);
      rank.position = 0;
    }
    thread.free_s = std::max(thread.free_s, rank.ready_s);
    return true;
  }

  void make(Thread& thread) {
    Rank& rank = ranks_[thread.rank];
    const BlockRun run =
        amplify::next_run(rank.blocks, rank.position, job_.threads, job_.max_blocks_per_run);
    rank.position += run.count();
    const double seconds = job_.seconds_of(run);
    report_.core_seconds += seconds;
    report_.rank_busy_s[thread.rank] += seconds;
    double& core_free_s = *std::ranges::min_element(rank.cores_free_s);
    thread.free_s = core_free_s = std::max(thread.free_s, core_free_s) + seconds;
    thread.bytes = job_.bytes_of ? job_.bytes_of(run) : 0;
    thread.files = thread.bytes > 0 ? run.count() : 0;
  }

  void write(Thread& thread) {
    const MachineLimits& limits = job_.limits;
    const double at_s = thread.free_s, bytes = std::exchange(thread.bytes, 0);
    const auto files = static_cast<double>(std::exchange(thread.files, 0));
    Server& link = ranks_[thread.rank].link;
    thread.free_s = std::max({link.serve(at_s, bytes / limits.rank_bytes_per_second),
                              storage_.serve(at_s, bytes / limits.storage_bytes_per_second),
                              metadata_.serve(at_s, files / limits.storage_files_per_second)}) +
                    files * limits.file_latency_s;
  }

  VirtualReport finish() {
    for (const double end_s : report_.rank_end_s)
      report_.makespan_s = std::max(report_.makespan_s, end_s);
    const double all_s = report_.makespan_s;
    if (!(all_s > 0)) return report_;
    const unsigned cores = job_.cores > 0 ? job_.cores : job_.threads;
    report_.efficiency = report_.core_seconds / (all_s * job_.ranks * cores);
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
      report_.worst_rank_idle =
          std::max(report_.worst_rank_idle, 1 - report_.rank_end_s[i] / all_s);
      report_.link_busy = std::max(report_.link_busy, ranks_[i].link.busy_s / all_s);
    }
    report_.storage_busy = storage_.busy_s / all_s;
    report_.metadata_busy = metadata_.busy_s / all_s;
    report_.claims_busy = claims_.busy_s / all_s;
    return report_;
  }

  const Plan& plan_;
  const VirtualJob& job_;
  std::vector<Rank> ranks_;
  std::priority_queue<Thread, std::vector<Thread>, std::greater<>> threads_;
  Server claims_, storage_, metadata_;
  VirtualReport report_;
};

}  // namespace

VirtualReport simulate(const Plan& plan, const VirtualJob& job) {
  PSYGEN_CHECK(job.ranks >= 1 && job.threads >= 1, "a job needs at least one rank and one thread");
  return Simulation(plan, job).run();
}

}  // namespace psygen::cluster
