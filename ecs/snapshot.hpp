// A world as bytes and back, for saved games and editors. Versioned and checksummed; little-endian.
// Handles keep their meaning: entities, generations, free slots, the order of rows, children and
// sparse components are restored exactly. Values are stored field by field, by name (fields.hpp),
// so types may gain and lose fields. Components without fields are transient: the snapshot stores
// which entities have them, and loading value-initialises them. Not file I/O: writing files is the
// caller's (write to a temporary name and rename). Change readers are not part of a world's state:
// after a load all rows are new. Called on the world's thread.
//
// A part of a world (the entities of a game in a world that holds others) is saved with
// save_snapshot_of and comes back with append_snapshot. Its entities then have new handles.
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

// The same of the entities that have C alone. Handles of other entities, in fields and in lists of
// children, are left out: a field is then kNullEntity, a list shorter. Costs a few ns for every
// entity of the world besides.
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
  kTypeMismatch,      // a field has another type, or a component is kept elsewhere now
  kTooLarge,          // beyond this world's WorldLimits, or unreasonably long lists
  kWorldInUse,        // the world has had entities before
};

// What load_snapshot returns; true in a condition when the world was loaded.
struct SnapshotResult {
  SnapshotStatus status = SnapshotStatus::kLoaded;
  std::string sentence;  // what is wrong and where; empty when loaded
  // Whether the world was loaded.
  explicit operator bool() const { return status == SnapshotStatus::kLoaded; }
};

// Fills a world that never had an entity and that knows all component types of the snapshot (see
// World::declare). Everything is checked before anything is changed: unless the result is kLoaded,
// the world is as it was. When a component's constructor or an allocation throws, the exception
// passes through and the world has no entities. Fields that the snapshot lacks keep the value of a
// new component; fields that the type lacks are skipped. Safe on any bytes. O(bytes), two passes.
[[nodiscard]] SnapshotResult load_snapshot(std::span<const std::byte> bytes, World& world);

// Adds the entities of a snapshot to a world that may have others. They get new handles; handles
// in their fields and lists follow, those of the dead become kNullEntity. `appended` (may be null)
// gets the new handles in the order of their kinds. Otherwise as load_snapshot(): unless the result
// is kLoaded, the world has no entity more. Not while a query is iterated.
[[nodiscard]] SnapshotResult append_snapshot(std::span<const std::byte> bytes, World& world,
                                             std::vector<Entity>* appended = nullptr);

// A hash of everything that save_snapshot stores: equal for worlds in the same state. Costs a save.
std::uint64_t state_hash(const World& world);

}  // namespace psygen::ecs
