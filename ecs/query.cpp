#include "ecs/query.hpp"

namespace psygen::ecs::detail {

void RowFilter::want(const Storage& storage, const ComponentInfo& info) {
  const ComponentId id = storage.find_id(info);
  if (id == kNoComponent) {
    impossible_ = true;
  } else if (info.sparse) {
    with_[with_count_++] = storage.record(id).sparse.get();
  } else {
    wanted_.insert(id);
  }
}

void RowFilter::refuse(const Storage& storage, const ComponentInfo& info) {
  const ComponentId id = storage.find_id(info);
  if (id == kNoComponent) return;
  if (!info.sparse) {
    unwanted_.insert(id);
  } else if (storage.record(id).sparse->rows().rows() > 0) {
    without_[without_count_++] = storage.record(id).sparse.get();
  }
}

bool RowFilter::fits(Entity entity) const {
  for (std::size_t i = 0; i < with_count_; ++i) {
    if (!with_[i]->contains(entity)) return false;
  }
  for (std::size_t i = 0; i < without_count_; ++i) {
    if (without_[i]->contains(entity)) return false;
  }
  return true;
}

}  // namespace psygen::ecs::detail
