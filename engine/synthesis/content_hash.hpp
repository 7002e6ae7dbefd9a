// Hashes that prove that two runs synthesised the same world. The hash of a mesh covers its key and
// every byte written. The hash of a world is a sum, so neither the number of modelers nor the order
// of completion matters. Pure functions; any thread.
#pragma once

#include <cstdint>

#include "engine/models/model_type.hpp"
#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

// `mesh` is fully written. Shared indices are covered by the key (they depend on the level alone).
inline std::uint64_t content_hash(const MeshKey& key, const models::MeshView& mesh) {
  const std::uint64_t h =
      core::combine(hash_of(key), core::hash_bytes({mesh.vertices.data(), mesh.vertices.size()}));
  return core::combine(h, core::hash_bytes(std::as_bytes(mesh.indices)));
}

// Sum of the hashes of a world's meshes. The order of add() does not matter.
class WorldHash {
 public:
  // The content_hash() of one mesh.
  void add(std::uint64_t mesh_hash) {
    sum_ += core::mix64(mesh_hash);
    ++count_;
  }
  // Adds the hash of another part of the same world.
  void add(const WorldHash& part) {
    sum_ += part.sum_;
    count_ += part.count_;
  }
  // Restores a hash from a stored sum() and count().
  static WorldHash restored(std::uint64_t sum, std::uint64_t count) {
    WorldHash hash;
    hash.sum_ = sum;
    hash.count_ = count;
    return hash;
  }
  std::uint64_t sum() const { return sum_; }
  // Number of meshes added, and the hash of all of them.
  std::uint64_t count() const { return count_; }
  std::uint64_t value() const { return core::combine(sum_, count_); }

 private:
  std::uint64_t sum_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace psygen::synthesis
