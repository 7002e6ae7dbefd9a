#include "engine/cli/rank_threads.hpp"

#include <sched.h>

#include <thread>

#include "engine/cluster/job.hpp"

namespace psygen::cli {
namespace {

unsigned allowed_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return std::thread::hardware_concurrency();
  return static_cast<unsigned>(CPU_COUNT(&set));
}

}  // namespace

unsigned threads_for_rank(const cluster::Peers& peers) {
  return cluster::threads_for_rank(allowed_processors(), std::thread::hardware_concurrency(),
                                   peers.count_here());
}

}  // namespace psygen::cli
