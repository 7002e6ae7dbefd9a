#include "ecs/sparse_set.hpp"

#include <algorithm>

#include "ecs/check.hpp"

namespace psygen::ecs::detail {
namespace {

std::vector<Column> one_column(ComponentId id, const ComponentInfo& info, std::size_t max_rows) {
  std::vector<Column> columns;
  columns.push_back({&info, id, ReservedMemory(max_rows * info.size_bytes, 320)});
  return columns;
}

Signature only(ComponentId id) {
  Signature result;
  result.insert(id);
  return result;
}

}  // namespace

SparseSet::SparseSet(ComponentId id, const ComponentInfo& info, std::size_t max_entities,
                     std::size_t max_rows)
    : rows_(0, only(id), one_column(id, info, max_rows), max_rows),
      memory_(std::min<std::size_t>(max_entities, UINT32_MAX) * sizeof(std::uint32_t)) {}

std::size_t SparseSet::add(std::span<const Entity> entities, const EntitySlots& slots) {
  if (entities.empty()) return 0;
  const std::size_t room = std::min(entities.size(), rows_.max_rows() - rows_.rows());
  rows_.reserve_more(room);
  memory_.commit(slots.used() * sizeof(std::uint32_t));
  indexed_ = slots.used();
  const std::uint32_t first = rows_.rows();
  Entity* const members = rows_.entities();
  std::uint32_t* const rows_after = row_after();
  std::uint32_t end = first;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + kPrefetchAhead < entities.size()) {
      slots.prefetch(entities[i + kPrefetchAhead]);
      prefetch(entities[i + kPrefetchAhead]);
    }
    const Entity entity = entities[i];
    const Slot* slot = slots.find(entity);
    if (slot == nullptr || slot->location == kNowhere || rows_after[entity.index] != 0) continue;
    if (end - first == room) give_up("a sparse component has max_rows_per_table members");
    members[end] = entity;
    rows_after[entity.index] = ++end;
  }

  try {
    rows_.construct_new_rows(end - first, Signature{});
  } catch (...) {
    for (std::uint32_t row = first; row < end; ++row)
      rows_after[members[row].index] = 0;
    throw;
  }
  rows_.add_rows(end - first);
  return end - first;
}

}  // namespace psygen::ecs::detail
