// The common format of saving and loading snapshots: the header, the checksum, and the storage of
// types.
//
//   "psyg-ecs", u32 version, u64 bytes of what follows up to the checksum
//   components: u32 count; each: string name, u8 sparse, u8 described, type if described
//   slots:      u32 count, u32 generation each; u32 free count, u32 index each (last is next)
//   tables:     u32 count; each: u32 components, u32 each; u32 rows, handles, columns
//   sparse:     u32 count; each: u32 component; u32 rows, handles, column
//   u64 checksum of all bytes before it
//
// A string is a u32 length and its bytes; a handle is u32 index, u32 generation; a list is a u32
// length and its elements; other values are their bytes. Nothing is aligned. Internal to the
// library.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "ecs/children.hpp"
#include "ecs/component.hpp"
#include "ecs/fields.hpp"
#include "ecs/world.hpp"

namespace psygen::ecs::detail {

static_assert(std::endian::native == std::endian::little, "snapshots are little-endian");

// The header: magic bytes, the version that this library writes, and sizes in bytes.
inline constexpr std::string_view kSnapshotMagic = "psyg-ecs";
inline constexpr std::uint32_t kSnapshotVersion = 1;
inline constexpr std::size_t kSnapshotHeaderBytes = 8 + 4 + 8;
inline constexpr std::size_t kSnapshotChecksumBytes = 8;

// Returns a 64-bit hash of the bytes and their number. Every step is a bijection of the state, so
// changing one word always changes the result. Not cryptographic.
inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t h = 0x243F6A8885A308D3ull ^ bytes.size();
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    h = (h ^ word) * 0x9E3779B97F4A7C15ull;
    h ^= h >> 32;
  }
  return h;
}

// True for Children, whose list is stored instead of the component.
inline bool is_children(const ComponentInfo& info) {
  return &info == &kComponentInfo<Children>;
}
// Returns the stored type of a component; null if its value is not stored.
inline const TypeDescription* described(const ComponentInfo& info) {
  return is_children(info) ? &description_of<std::vector<Entity>>() : info.describe();
}

// Gives saving and loading access to a world's storage.
class SnapshotAccess {
 public:
  // The storage, to read or to fill.
  static const Storage& storage(const World& world) { return world.storage_; }
  static Storage& storage(World& world) { return world.storage_; }
};

}  // namespace psygen::ecs::detail
