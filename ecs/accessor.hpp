// Random access to one component by handle; it looks up everything else once. Not for walking whole
// tables: iterate instead. A system that follows handles holds an accessor. It stays valid as long
// as its world, also across structural changes, and reads on any thread while nothing changes the
// structure. get is O(1).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <type_traits>

#include "ecs/storage.hpp"

namespace psygen::ecs {

// Made by World::accessor or Query::accessor. `Accessor<const C>` only reads.
template <class C>
class Accessor {
  using Value = std::remove_const_t<C>;

 public:
  // Returns the entity's component; null if the entity is dead or lacks it. The pointer is valid
  // until the next structural change.
  C* get(Entity entity) const {
    if constexpr (is_sparse<Value>()) {
      return find(entity).value;
    } else {
      const detail::Slot* slot = slots_->find(entity);
      return slot == nullptr ? nullptr : detail::row_at<Value>(*record_, slot->location);
    }
  }

  // Calls f(i, get(entities[i])) for every i in order and prefetches the next components: the fast
  // way to follow many handles. `f` may write through the pointer and must not change structure.
  template <class F>
  void each(std::span<const Entity> entities, F&& f) const;

  // Hints that get(entity) follows soon. Loads the entity's location, not the component itself.
  void prefetch(Entity entity) const {
    if constexpr (is_sparse<Value>()) {
      if (record_->sparse != nullptr) record_->sparse->prefetch(entity);
    } else {
      slots_->prefetch(entity);
    }
  }

 private:
  friend class World;
  struct Found {
    C* value;  // null for entities that are dead or lack the component
    detail::RowPlace at;
  };
  Found find(Entity entity) const {
    if constexpr (is_sparse<Value>()) {
      const detail::SparseSet* set = record_->sparse.get();
      const std::uint32_t row = set == nullptr ? detail::SparseSet::kNoRow : set->row_of(entity);
      if (row == detail::SparseSet::kNoRow) return {nullptr, {}};
      return {detail::rows_of<Value>(set->column()) + row, {0, row}};
    } else {
      const detail::Slot* slot = slots_->find(entity);
      if (slot == nullptr) return {nullptr, {}};
      return {detail::row_at<Value>(*record_, slot->location),
              storage_->directory().place_of(slot->location)};
    }
  }
  Accessor(const detail::Storage& storage, const detail::ComponentRecord& record)
      : storage_(&storage), slots_(&storage.slots()), record_(&record) {}

  const detail::Storage* storage_;
  const detail::EntitySlots* slots_;
  const detail::ComponentRecord* record_;
};

template <class C>
template <class F>
void Accessor<C>::each(std::span<const Entity> entities, F&& f) const {
  const detail::IterationGuard guard(storage_->iteration(), detail::kQuery<C>);
  constexpr std::size_t kAhead = detail::kPrefetchAhead;
  std::array<C*, kAhead> found;  // ring of entities [i, i + kAhead)
  const std::size_t count = entities.size();
  for (std::size_t i = 0; i < count + kAhead; ++i) {
    if (i >= kAhead) f(i - kAhead, found[i % kAhead]);
    if (i + kAhead < count) prefetch(entities[i + kAhead]);
    if (i >= count) continue;
    found[i % kAhead] = get(entities[i]);
    __builtin_prefetch(found[i % kAhead]);
  }
}

}  // namespace psygen::ecs
