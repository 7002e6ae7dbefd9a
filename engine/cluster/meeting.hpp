// Checks that all ranks agree: before the first block that they run the same job, and before a
// flight that they make the same meshes. Collective; all ranks get the same result. Main thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/amplify/ledger.hpp"
#include "engine/cluster/peers.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::cluster {

// Succeeds if all ranks have the same key, and either all or none have a folder. `mine` is this
// rank's key, or the reason why it has none. Fails with kInvalidArgument; the message names the
// first rank that differs from rank 0, its machine and its instruction set.
core::Result<void> check_same_job(const core::Result<amplify::JobKey>& mine, bool with_folder,
                                  Peers& peers);

// Succeeds if all ranks see the same folder: rank 0 creates it and writes a file that the others
// look for. Fails with kIo or kInvalidArgument.
core::Result<void> check_folder(const std::filesystem::path& folder, Peers& peers);

// Returns the first error of any rank to all ranks; `mine` is the result of this rank.
core::Result<void> agree(const core::Result<void>& mine, Peers& peers);
template <class T>
core::Result<void> agree(const core::Result<T>& mine, Peers& peers) {
  return agree(mine ? core::Result<void>{} : tl::unexpected(mine.error()), peers);
}

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
