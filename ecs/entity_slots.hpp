// Where every entity is: slot i tells the generation and location of the entity with index i.
// A free slot already has its next generation, so that old handles are stale. A slot whose
// generations are used up retires: it is never given out again. 8 bytes per entity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ecs/entity.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/row_directory.hpp"

namespace psygen::ecs::detail {

struct Slot {
  std::uint32_t generation;
  std::uint32_t location;  // see RowDirectory; kNowhere while free
};
static_assert(sizeof(Slot) == 8);

class EntitySlots {
 public:
  // `first_generation` (at least 1) is the generation of a slot's first entity.
  EntitySlots(std::size_t max_entities, std::uint32_t first_generation);

  // The slot that the handle's index names, when the generation fits as well. A forged handle may
  // name a free slot: its location is kNowhere.
  Slot* find(Entity entity) const {
    if (entity.index >= count_) return nullptr;
    Slot* slot = slots() + entity.index;
    return slot->generation == entity.generation ? slot : nullptr;
  }
  Slot& operator[](std::uint32_t index) const { return slots()[index]; }
  void prefetch(Entity entity) const {
    if (entity.index < count_) __builtin_prefetch(slots() + entity.index);
  }

  // Makes room for so many more entities. Throws std::bad_alloc when there is none.
  void reserve_more(std::size_t count);
  // Handles for the rows at first_location, first_location + 1, ..., written to `out`.
  void issue(std::span<Entity> out, std::uint32_t first_location);
  // The entity of a living slot dies.
  void release(Slot& slot) {
    slot.location = kNowhere;
    if (++slot.generation != 0) {
      free_.push_back(static_cast<std::uint32_t>(&slot - slots()));
    } else {
      ++retired_;
    }
  }

  // As another world had them; nobody lives yet. Generation 0 is a slot that has retired.
  void restore(std::span<const std::uint32_t> generations, std::span<const std::uint32_t> free);
  // Free slots; the last one is issued next.
  std::span<const std::uint32_t> free() const { return free_; }

  // Slots that were ever used: indices of entities are below.
  std::uint32_t used() const { return count_; }
  std::size_t living() const { return count_ - free_.size() - retired_; }
  std::size_t retired() const { return retired_; }
  std::size_t committed_bytes() const { return memory_.committed_bytes(); }

 private:
  Slot* slots() const { return reinterpret_cast<Slot*>(memory_.data()); }

  ReservedMemory memory_;
  std::vector<std::uint32_t> free_;  // last in, first out: recently used slots are in cache
  std::size_t max_entities_;
  std::size_t retired_ = 0;
  std::uint32_t count_ = 0;  // slots ever used
  std::uint32_t first_generation_;
};

}  // namespace psygen::ecs::detail
