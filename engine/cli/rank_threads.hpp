// How many threads a rank of a cluster has on this machine. Main thread.
#pragma once

#include "engine/cluster/peers.hpp"

namespace psygen::cli {

// For a rank that is not told: the processors that it may run on, or its part of the machine's,
// whichever is less; at least one.
unsigned threads_for_rank(const cluster::Peers& peers);

}  // namespace psygen::cli
