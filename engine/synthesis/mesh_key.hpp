// What names a mesh (MeshKey) and what names its place in the cache (MeshHandle). Values only.
// A key says which mesh of the world is meant; two equal keys give the same bits of geometry.
// A handle says where the cache keeps it; stale handles are recognised by their generation.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/registry.hpp"

namespace psygen::synthesis {

// Names a mesh of the world.
struct MeshKey {
  core::BlockCoord block;
  std::uint32_t index = 0;            // which model of the block; 0 is usually its terrain
  models::ModelIndex model = 0;       // type, in the registry's order
  std::uint16_t level = 0;            // of detail, 0 is full
  std::uint64_t parameters_hash = 0;  // models::Parameters::hash(): an edit makes another key
  bool spare = false;                 // the same mesh once more, see spare_of()
  friend bool operator==(const MeshKey&, const MeshKey&) = default;
};

// The same value on every machine: it is part of content hashes.
constexpr std::uint64_t hash_of(const MeshKey& key) {
  const std::uint64_t block = (std::uint64_t{static_cast<std::uint32_t>(key.block.x)} << 32) |
                              static_cast<std::uint32_t>(key.block.z);
  const std::uint64_t model = (std::uint64_t{key.index} << 32) | (std::uint64_t{key.model} << 16) |
                              std::uint64_t{key.level};
  const std::uint64_t hash = core::combine(core::combine(block, model), key.parameters_hash);
  return key.spare ? core::combine(hash, 0x5BA2E) : hash;
}

// A second name of the same mesh, for when a modeler holds the first and must not be waited for.
constexpr MeshKey spare_of(MeshKey key) {
  key.spare = true;
  return key;
}

// empty → requested → ready, or failed. A key that the cache does not know is empty.
enum class MeshState : std::uint8_t { kEmpty, kRequested, kReady, kFailed };
// "empty", "requested", "ready", "failed".
std::string_view name_of(MeshState state);

// A place in the cache.
using Slot = std::uint32_t;
inline constexpr Slot kNoSlot = UINT32_MAX;

// Names a place in the cache and its tenant. Null by default.
struct MeshHandle {
  Slot slot = kNoSlot;
  std::uint32_t generation = 0;
  constexpr explicit operator bool() const { return slot != kNoSlot; }
  friend bool operator==(const MeshHandle&, const MeshHandle&) = default;
};
static_assert(sizeof(MeshHandle) == 8);
inline constexpr MeshHandle kNoMesh{};

}  // namespace psygen::synthesis

// For std::unordered_map and its like.
template <>
struct std::hash<psygen::synthesis::MeshKey> {
  std::size_t operator()(const psygen::synthesis::MeshKey& key) const noexcept {
    return static_cast<std::size_t>(psygen::synthesis::hash_of(key));
  }
};
