// Handshake before a flight: all ranks check that they make the same meshes. Collective; all ranks
// get the same result. Main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/cluster/peers.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::cluster {

// A model type and the hash of the mesh that it makes from its default parameters.
struct TypeFingerprint {
  std::string name;
  std::uint64_t identity = 0;
  int levels = 0;
  std::uint64_t sample_hash = 0;  // mesh hash of the coarsest LOD; 0: synthesis fails
  friend bool operator==(const TypeFingerprint&, const TypeFingerprint&) = default;
};

// Values that all ranks must have in common.
struct CompatibilityKey {
  std::string version;                 // of psygen
  std::string world;                   // name of the world definition, for messages
  std::uint64_t world_hash = 0;        // world::world_hash()
  std::vector<TypeFingerprint> types;  // of the registry, in order
};

// Builds the key of a flight. Synthesises one mesh of each type.
CompatibilityKey compatibility_key(const world::World& world, const models::Registry& registry,
                                   std::string_view version);

// Compares the keys of all ranks and returns the number of threads of each rank. `mine` is this
// rank's key, or the reason why it has none. `threads` counts the threads of this rank that will
// make meshes. Fails with the first error of any rank, or with kInvalidArgument and a message that
// names the first rank that differs from rank 0, and its machine.
core::Result<std::vector<unsigned>> meet(const core::Result<CompatibilityKey>& mine,
                                         unsigned threads, Peers& peers);

}  // namespace psygen::cluster
