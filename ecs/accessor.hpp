// Random access to one component by handle, with everything looked up once. Hold it in a system
// that follows handles; for whole tables iterate instead. Stays valid as long as its world, also
// across structural changes. `Accessor<const C>` reads only.
#pragma once

#include <type_traits>

#include "ecs/storage.hpp"

namespace psygen::ecs {

template <class C>
class Accessor {
 public:
  // The entity's component, null when the entity is dead or has none. The pointer is valid until
  // the next structural change.
  C* get(Entity entity) const {
    const detail::Slot* slot = slots_->find(entity);
    return slot == nullptr ? nullptr : row_at(slot->location);
  }

  // A hint that get(entity) follows soon: loads where the entity is, not the component itself.
  void prefetch(Entity entity) const { slots_->prefetch(entity); }

 private:
  friend class World;
  struct Found {
    C* value;  // null for dead entities and those without the component
    detail::RowPlace at;
  };
  Found find(Entity entity) const {
    const detail::Slot* slot = slots_->find(entity);
    if (slot == nullptr) return {nullptr, {}};
    return {row_at(slot->location), directory_->place_of(slot->location)};
  }
  C* row_at(std::uint32_t location) const {
    std::byte* rows = record_->rows_of_chunk[location / detail::kChunkRows];
    if (rows == nullptr) return nullptr;
    return detail::rows_of<std::remove_const_t<C>>(rows) + location % detail::kChunkRows;
  }

  Accessor(const detail::Storage& storage, const detail::ComponentRecord& record)
      : slots_(&storage.slots()), directory_(&storage.directory()), record_(&record) {}

  const detail::EntitySlots* slots_;
  const detail::RowDirectory* directory_;
  const detail::ComponentRecord* record_;
};

}  // namespace psygen::ecs
