// Adapts the edits of a save to a world that has changed since it was saved: says which changes
// touch them, and separates those that no longer fit. Reads the tables and changes nothing. Private
// to engine/save. One thread at a time.
#pragma once

#include <optional>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/save/save_game.hpp"
#include "engine/save/save_tables.hpp"
#include "engine/world/world.hpp"

namespace psygen::save {

// A hash of the ground of a block without edits, and of the water over it: equal if edits there
// stand on the same ground and equally deep in water. About 10 µs.
std::uint64_t surface_hash(const world::World& world, core::BlockCoord block);

// The world that a save is opened with.
struct CurrentWorld {
  WorldIdentity identity;
  std::optional<world::World> world = {};      // without edits
  const models::Registry* registry = nullptr;  // set if `world` is
};

// The result of adapting all edits.
struct Adaptation {
  UnsavedEdits edits;                          // of the blocks that change
  std::optional<std::vector<KeptEdits>> kept;  // all of them, if they change
  std::vector<Misfit> misfits;
};

// Adapts the edits of a file that was last saved in the world `before`. Fails with kInvalidArgument
// and the changes that touch edits unless `accept` allows them. Without CurrentWorld::world it
// moves no edits. O(bytes of the edits).
core::Result<Adaptation> adapt(SaveTables& tables, const WorldIdentity& before,
                               const CurrentWorld& now, Accept accept);

}  // namespace psygen::save
