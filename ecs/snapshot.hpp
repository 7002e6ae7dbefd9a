// Saves a world as bytes and restores it, for saved games and editors. Versioned and checksummed;
// little-endian. Handles keep their meaning: a load restores entities, generations, free slots, the
// order of rows, children and sparse components exactly. Values are stored field by field, by name
// (fields.hpp), so types may gain and lose fields. Components without fields are transient: the
// snapshot stores which entities have them, and loading value-initialises them. Not file I/O: the
// caller writes files (under a temporary name, then rename). Change readers are not part of a
// world's state: after a load all rows are new. Called on the world's thread.
//
// save_snapshot_of saves a part of a world (the entities of a game in a world that holds others),
// and append_snapshot restores it. Its entities then have new handles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ecs/world.hpp"

namespace psygen::ecs {

// Worlds in the same state give the same bytes. About 20 ns per entity and component.
std::vector<std::byte> save_snapshot(const World& world);

namespace detail {
std::vector<std::byte> save_snapshot_of(const World& world, const ComponentInfo& component);
}  // namespace detail

// Saves only the entities that have C. Handles of other entities, in fields and in lists of
// children, are dropped: a field becomes kNullEntity, a list shorter. Costs in addition a few ns
// for every entity of the world.
template <Component C>
std::vector<std::byte> save_snapshot_of(const World& world) {
  return detail::save_snapshot_of(world, detail::kComponentInfo<C>);
}

// The outcome of a load.
enum class SnapshotStatus : std::uint8_t {
  kLoaded,
  kNotASnapshot,
  kNewerVersion,
  kTruncated,
  kCorrupt,           // the checksum does not match, or the content is invalid
  kUnknownComponent,  // not declared in this world (World::declare)
  kTypeMismatch,      // a field has another type, or a component has another storage now
  kTooLarge,          // beyond this world's WorldLimits, or unreasonably long lists
  kWorldInUse,        // the world has had entities before
};

// Result of a load. True in a condition if the world was loaded.
struct SnapshotResult {
  SnapshotStatus status = SnapshotStatus::kLoaded;
  std::string sentence;  // the error message, with its position; empty when loaded
  // True if the world was loaded.
  explicit operator bool() const { return status == SnapshotStatus::kLoaded; }
};

// Fills a world that never had an entity and that knows all component types of the snapshot (see
// World::declare). It checks everything before it changes anything: unless the result is kLoaded,
// the world is unchanged. If a component's constructor or an allocation throws, the exception
// passes through and the world has no entities. Fields that the snapshot lacks keep the value of a
// new component; fields that the type lacks are skipped. Safe on any bytes. O(bytes), two passes.
[[nodiscard]] SnapshotResult load_snapshot(std::span<const std::byte> bytes, World& world);

// Adds the entities of a snapshot to a world that may have others. They get new handles; handles in
// their fields and lists follow, and those of dead entities become kNullEntity. `appended` (may be
// null) receives the new handles in the order of their archetypes. Otherwise like load_snapshot():
// unless the result is kLoaded, the world has no new entity. Not while a query is iterated.
[[nodiscard]] SnapshotResult append_snapshot(std::span<const std::byte> bytes, World& world,
                                             std::vector<Entity>* appended = nullptr);

// Hash of everything that save_snapshot stores: equal for worlds in the same state. Costs a save.
std::uint64_t state_hash(const World& world);

}  // namespace psygen::ecs
