// A world as bytes and back, for saved games and editors. Versioned and checksummed; little-endian.
// Handles keep their meaning: entities, generations and free slots are restored exactly, and so are
// the rows' order, children and sparse components. Values are kept field by field, by name
// (fields.hpp), so that types may gain and lose fields; components without fields are transient:
// who has them is kept, their value starts anew. Files are the caller's (write to a temporary name
// and rename). Change readers are not part of a world's state: after a load all rows are new.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ecs/world.hpp"

namespace psygen::ecs {

// The same world gives the same bytes. About 20 ns per entity and component.
std::vector<std::byte> save_snapshot(const World& world);

enum class SnapshotStatus : std::uint8_t {
  kLoaded,
  kNotASnapshot,
  kNewerVersion,
  kTruncated,
  kCorrupt,           // the checksum does not fit, or what it protects makes no sense
  kUnknownComponent,  // not declared in this world (World::declare)
  kTypeMismatch,      // a field has another type now
  kTooLarge,          // more than this world's WorldLimits, or lists beyond all measure
  kWorldInUse,        // the world had entities before
};

struct SnapshotResult {
  SnapshotStatus status = SnapshotStatus::kLoaded;
  std::string sentence;  // what is wrong and where; empty when loaded
  explicit operator bool() const { return status == SnapshotStatus::kLoaded; }
};

// Fills a world that never had an entity and in which all component types of the snapshot are
// known. Everything is checked before anything is changed: unless it returns kLoaded, the world is
// as it was. When a component's constructor or memory throws, the exception passes through and the
// world has no entities. Fields that the snapshot lacks keep the value of a new component; fields
// that the type lacks are skipped. Safe on any bytes.
[[nodiscard]] SnapshotResult load_snapshot(std::span<const std::byte> bytes, World& world);

// A hash of everything that save_snapshot keeps: equal for worlds in the same state.
std::uint64_t state_hash(const World& world);

}  // namespace psygen::ecs
