// Storage of a sparse component (ComponentTraits<C>::sparse), which entities gain and lose often:
// one table for all entities that have it, whatever their archetype, and an index from every entity
// to its row. Adding and removing move no other component. Untyped; Storage updates readers and
// slots. Lookups are O(1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ecs/entity.hpp"
#include "ecs/entity_slots.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/table.hpp"

namespace psygen::ecs::detail {

// The members of one sparse component of one world, with their values.
class SparseSet {
 public:
  // Result of row_of() for entities that are not members.
  static constexpr std::uint32_t kNoRow = UINT32_MAX;

  // Reserves address space for `max_rows` members among `max_entities` entities. Throws
  // std::bad_alloc if there is none. `info` outlives the set.
  SparseSet(ComponentId id, const ComponentInfo& info, std::size_t max_entities,
            std::size_t max_rows);

  // The members and their column. The table's id is 0, which no table of the world has.
  Table& rows() { return rows_; }
  const Table& rows() const { return rows_; }
  // Row 0 of the values. The address never changes.
  std::byte* column() const { return rows_.columns()[0].memory.data(); }

  // Returns the row of a member, else kNoRow. Stale handles are not members.
  std::uint32_t row_of(Entity entity) const {
    if (entity.index >= indexed_) return kNoRow;
    const std::uint32_t row = row_after()[entity.index] - 1;
    if (row >= rows_.rows()) return kNoRow;
    return rows_.entities()[row] == entity ? row : kNoRow;
  }
  // True if the entity is a member.
  bool contains(Entity entity) const { return row_of(entity) != kNoRow; }
  // Hints that row_of(entity) follows soon. Accepts any handle.
  void prefetch(Entity entity) const {
    if (entity.index < indexed_) __builtin_prefetch(row_after() + entity.index);
  }

  // Appends value-initialised rows for those of `entities` that live and are not members yet;
  // returns their number. If a constructor throws, no entity has joined. Ends the program beyond
  // `max_rows` members. O(entities).
  std::size_t add(std::span<const Entity> entities, const EntitySlots& slots);
  // Adds a member to rows().leaving, once; it then no longer is a member. Returns false for other
  // entities.
  bool leave(Entity entity) {
    const std::uint32_t row = row_of(entity);
    if (row == kNoRow) return false;
    row_after()[entity.index] = 0;
    rows_.leaving.push_back(row);
    return true;
  }
  // Updates the index after another member moved to `row`.
  void note_moved(std::uint32_t row) { row_after()[rows_.entities()[row].index] = row + 1; }

  // Committed bytes of rows and index.
  std::size_t committed_bytes() const {
    return rows_.committed_bytes() + memory_.committed_bytes();
  }

 private:
  std::uint32_t* row_after() const { return reinterpret_cast<std::uint32_t*>(memory_.data()); }

  Table rows_;
  ReservedMemory memory_;  // by entity index: row + 1, or 0 for an entity that is not a member
  std::size_t indexed_ = 0;
};

}  // namespace psygen::ecs::detail
