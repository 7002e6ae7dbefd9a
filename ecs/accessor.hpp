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
    if (slot == nullptr) return nullptr;
    std::byte* column = record_->column_of_table[slot->table];
    return column == nullptr ? nullptr
                             : detail::rows_of<std::remove_const_t<C>>(column) + slot->row;
  }

  // A hint that get(entity) follows soon: loads where the entity is, not the component itself.
  void prefetch(Entity entity) const { slots_->prefetch(entity); }

 private:
  friend class World;
  Accessor(const detail::EntitySlots& slots, const detail::ComponentRecord& record)
      : slots_(&slots), record_(&record) {}

  const detail::EntitySlots* slots_;
  const detail::ComponentRecord* record_;
};

}  // namespace psygen::ecs
