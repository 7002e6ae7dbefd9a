// Serves meshes to the flight of rank 0 (remote_modeler_pool.hpp). Knows model types, but no worlds
// and no visibility. Worker threads make the meshes; the calling thread receives requests.
#pragma once

#include <cstdint>

#include "engine/cluster/peers.hpp"
#include "engine/models/registry.hpp"

namespace psygen::cluster {

// Statistics of a serving rank.
struct ServeReport {
  std::uint64_t made = 0, failed = 0;  // meshes
  std::uint64_t refused = 0;           // damaged requests and unknown types
  // True if a model hangs. Its thread still uses the registry and the communicator, so the program
  // should leave through std::_Exit.
  bool hangs = false;
};

// Serves the requests of rank 0 with this number of threads until it sends kEnd. Then finishes the
// current meshes; a mesh hangs if it takes longer than `patience_s`, as for the watchdog of a
// flight. Requires meet() on all ranks and threads >= 1, the number given to meet(). Fails with
// kInternal if the system starts fewer threads.
core::Result<ServeReport> run_model_server(const models::Registry& registry, unsigned threads,
                                           Peers& peers, double patience_s = 10);

}  // namespace psygen::cluster
