// Where a toggled component (ComponentTraits<C>::sparse) is kept: one table of its own for all
// entities that have it, whatever their kind, and for every entity the row in it. Adding and
// removing move nobody's other components. Untyped; the storage keeps readers and slots in step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ecs/entity.hpp"
#include "ecs/entity_slots.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/table.hpp"

namespace psygen::ecs::detail {

class SparseSet {
 public:
  static constexpr std::uint32_t kNoRow = UINT32_MAX;

  SparseSet(ComponentId id, const ComponentInfo& info, std::size_t max_entities,
            std::size_t max_rows);

  // The members and their column. Its id is 0, which no table of the world has.
  Table& rows() { return rows_; }
  const Table& rows() const { return rows_; }
  std::byte* column() const { return rows_.columns()[0].memory.data(); }

  // The row of a member, else kNoRow. Stale handles are no members.
  std::uint32_t row_of(Entity entity) const {
    if (entity.index >= indexed_) return kNoRow;
    const std::uint32_t row = row_after()[entity.index] - 1;
    if (row >= rows_.rows()) return kNoRow;
    return rows_.entities()[row] == entity ? row : kNoRow;
  }
  bool contains(Entity entity) const { return row_of(entity) != kNoRow; }
  void prefetch(Entity entity) const {
    if (entity.index < indexed_) __builtin_prefetch(row_after() + entity.index);
  }

  // Value-initialised rows at the end for those of `entities` that live and are no members yet.
  // Returns how many. When a constructor throws, nobody joined.
  std::size_t add(std::span<const Entity> entities, const EntitySlots& slots);
  // Lists this member in rows().leaving, once; from then on it is none. False for others.
  bool leave(Entity entity) {
    const std::uint32_t row = row_of(entity);
    if (row == kNoRow) return false;
    row_after()[entity.index] = 0;
    rows_.leaving.push_back(row);
    return true;
  }
  // Row `row` has got another member.
  void note_moved(std::uint32_t row) { row_after()[rows_.entities()[row].index] = row + 1; }

  std::size_t committed_bytes() const {
    return rows_.committed_bytes() + memory_.committed_bytes();
  }

 private:
  std::uint32_t* row_after() const { return reinterpret_cast<std::uint32_t*>(memory_.data()); }

  Table rows_;
  ReservedMemory memory_;  // by index of the entity: row + 1, 0 for those that are no members
  std::size_t indexed_ = 0;
};

}  // namespace psygen::ecs::detail
