// Number of threads of a cluster's rank on this machine. Main thread.
#pragma once

#include "engine/cluster/peers.hpp"

namespace psygen::cli {

// Default number of threads of a rank: the processors that the process may use or the rank's part
// of the machine, whichever is smaller; at least 1.
unsigned threads_for_rank(const cluster::Peers& peers);

}  // namespace psygen::cli
