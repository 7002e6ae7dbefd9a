// Names of a mesh (MeshKey) and of its slot in the cache (MeshHandle). Values only. A key
// identifies a mesh of the world; equal keys give the same bits of geometry. A handle identifies a
// slot of the cache; its generation detects stale handles.
#pragma once

#include <array>
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
  std::uint32_t index = 0;            // model of the block; 0 is usually its terrain
  models::ModelIndex model = 0;       // type, in the registry's order
  std::uint16_t level = 0;            // LOD, 0 is full detail
  std::uint64_t parameters_hash = 0;  // models::Parameters::hash(): an edit gives another key
  bool spare = false;                 // a second copy of the mesh, see duplicate_of()
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

// Key of a duplicate of a mesh, for when a modeler holds the first and waiting for it is too slow.
constexpr MeshKey duplicate_of(MeshKey key) {
  key.spare = true;
  return key;
}

// empty → requested → ready or failed. A key unknown to the cache is empty.
enum class MeshState : std::uint8_t { kEmpty, kRequested, kReady, kFailed };
constexpr std::string_view name_of(MeshState state) {
  constexpr std::array<std::string_view, 4> kNames{"empty", "requested", "ready", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

// Index of a slot in the cache.
using Slot = std::uint32_t;
inline constexpr Slot kNoSlot = UINT32_MAX;

// Identifies a slot of the cache and the mesh in it. Null by default.
struct MeshHandle {
  Slot slot = kNoSlot;
  std::uint32_t generation = 0;
  constexpr explicit operator bool() const { return slot != kNoSlot; }
  friend bool operator==(const MeshHandle&, const MeshHandle&) = default;
};
static_assert(sizeof(MeshHandle) == 8);
inline constexpr MeshHandle kNoMesh{};

}  // namespace psygen::synthesis

// For std::unordered_map and other hash containers.
template <>
struct std::hash<psygen::synthesis::MeshKey> {
  // Not noexcept: libstdc++ then keeps the hash in each node of a container.
  std::size_t operator()(const psygen::synthesis::MeshKey& key) const {
    return static_cast<std::size_t>(psygen::synthesis::hash_of(key));
  }
};
