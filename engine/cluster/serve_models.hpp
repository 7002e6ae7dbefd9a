// A rank that makes meshes for the flight of rank 0 (remote_models.hpp). It knows model types and
// neither worlds nor what is seen. Threads of its own make meshes; the calling one receives.
#pragma once

#include <cstdint>

#include "engine/cluster/peers.hpp"
#include "engine/models/registry.hpp"

namespace psygen::cluster {

// What a rank did.
struct ServeReport {
  std::uint64_t made = 0, failed = 0;  // meshes
  std::uint64_t refused = 0;           // damaged requests, and types that are not known here
  // A model hangs: its thread still uses the registry and the peers, so the program should leave
  // through std::_Exit.
  bool hangs = false;
};

// Makes what rank 0 asks for, with so many threads, until it says that no more comes. Then what is
// being made is finished, or hangs if that takes longer than `patience_s`, as for the watchdog of a
// flight. Requires meet() at all ranks, and threads >= 1, as many as meet() was told. Fails with
// kInternal where the system gives fewer.
core::Result<ServeReport> serve_models(const models::Registry& registry, unsigned threads,
                                       Peers& peers, double patience_s = 10);

}  // namespace psygen::cluster
