// What the ranks of a flight find out about each other before it: whether they make the same
// meshes. All ranks call these, and all get the same answer. Main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/cluster/peers.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::cluster {

// A model type, and the mesh that it makes of its defaults.
struct KnownType {
  std::string name;
  std::uint64_t identity = 0;
  int levels = 0;
  std::uint64_t sample_hash = 0;  // of its coarsest level; 0: it fails
  friend bool operator==(const KnownType&, const KnownType&) = default;
};

// What ranks must have in common.
struct FlightKey {
  std::string version;           // of psygen
  std::string world;             // its name, for messages
  std::uint64_t world_hash = 0;  // world::world_hash()
  std::vector<KnownType> types;  // of its registry, in order
};

// The key of a flight. Makes one mesh of each type.
FlightKey flight_key(const world::World& world, const models::Registry& registry,
                     std::string_view version);

// Compares keys; `mine` may be why this rank has none. `threads`: that will make meshes on this
// rank. Returns those of all ranks. Fails with the first error of any rank, or with
// kInvalidArgument; the sentence names the first rank that differs from rank 0, and its machine.
core::Result<std::vector<unsigned>> meet(const core::Result<FlightKey>& mine, unsigned threads,
                                         Peers& peers);

}  // namespace psygen::cluster
