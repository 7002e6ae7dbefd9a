// Locations of all entities: slot i holds the generation and the location of the entity with index
// i. A free slot already has its next generation, so old handles are stale. A slot that has used up
// its generations retires and is never issued again. 8 bytes per entity. Not an owner of rows:
// tables are. Only the world's thread changes it; const functions may run on several threads while
// nothing changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ecs/entity.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/row_directory.hpp"

namespace psygen::ecs::detail {

// One slot. Its entity's index is its position in the array.
struct Slot {
  std::uint32_t generation;
  std::uint32_t location;  // see RowDirectory; kNowhere while the slot is free
};
static_assert(sizeof(Slot) == 8);

// All slots of one world. Slots never move in memory.
class EntitySlots {
 public:
  // Reserves address space for `max_entities` slots; throws std::bad_alloc if there is none.
  // `first_generation` (at least 1) is the generation of a slot's first entity.
  EntitySlots(std::size_t max_entities, std::uint32_t first_generation);

  // Returns the slot of the handle's index if the generation matches too, else null. A forged
  // handle may name a free slot, whose location is kNowhere. O(1).
  Slot* find(Entity entity) const {
    if (entity.index >= count_) return nullptr;
    Slot* slot = slots() + entity.index;
    return slot->generation == entity.generation ? slot : nullptr;
  }
  // The slot of an index below used().
  Slot& operator[](std::uint32_t index) const { return slots()[index]; }
  // Hints that find(entity) follows soon. Accepts any handle.
  void prefetch(Entity entity) const {
    if (entity.index < count_) __builtin_prefetch(slots() + entity.index);
  }

  // Commits memory for `count` more entities. Throws std::bad_alloc if there is none; ends the
  // program beyond max_entities.
  void reserve_more(std::size_t count);
  // Writes one handle per element of `out`, for the rows at first_location, first_location + 1, ...
  // Free slots are reused first. Commits memory like reserve_more. O(handles).
  void issue(std::span<Entity> out, std::uint32_t first_location);
  // Ends the entity of a living slot: its handle becomes stale and the slot free or retired.
  void release(Slot& slot) {
    slot.location = kNowhere;
    if (++slot.generation != 0) {
      free_.push_back(static_cast<std::uint32_t>(&slot - slots()));
    } else {
      ++retired_;
    }
  }

  // Restores the slots of another world without living entities. Generation 0 marks a retired slot;
  // `free` lists the free slots.
  void restore(std::span<const std::uint32_t> generations, std::span<const std::uint32_t> free);
  // Indices of free slots; the last one is issued next. Valid until the next issue or release.
  std::span<const std::uint32_t> free() const { return free_; }

  // Number of slots ever used. Indices of entities are below it.
  std::uint32_t used() const { return count_; }
  // Numbers of living entities and of retired slots.
  std::size_t living() const { return count_ - free_.size() - retired_; }
  std::size_t retired() const { return retired_; }
  // Committed bytes of slot memory.
  std::size_t committed_bytes() const { return memory_.committed_bytes(); }

 private:
  Slot* slots() const { return reinterpret_cast<Slot*>(memory_.data()); }

  ReservedMemory memory_;
  std::vector<std::uint32_t> free_;  // last in, first out, because recently used slots are in the
                                     // cache
  std::size_t max_entities_;
  std::size_t retired_ = 0;
  std::uint32_t count_ = 0;  // slots ever used
  std::uint32_t first_generation_;
};

}  // namespace psygen::ecs::detail
