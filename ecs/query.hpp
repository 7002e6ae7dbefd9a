// Iteration: selects the rows that a query visits, and passes each run of them as spans. One call
// per table; filters by a sparse component cut tables into runs of matching rows. Not a cache: each
// walk matches tables again, O(tables) plus the rows visited. Several threads may iterate while
// nothing changes structure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "ecs/storage.hpp"

namespace psygen::ecs {

// Filters: components that entities must also have, or must not have:
//   world.each<A>(f, With<Selected>{}, Without<Hidden>{})
// With<sparse component> walks the smallest of the named sets. Without<sparse component> costs one
// look-up per row if the set has members.
template <Component... Cs>
struct With {};
template <Component... Cs>
struct Without {};

namespace detail {

// The number of times that C occurs in Cs, and a flag that is true if every component occurs once.
template <class C, class... Cs>
inline constexpr std::size_t kCount = (std::size_t{0} + ... + std::size_t{std::is_same_v<C, Cs>});
template <class... Cs>
inline constexpr bool kDistinct =
    ((kCount<std::remove_const_t<Cs>, std::remove_const_t<Cs>...> == 1) && ...);

// Defined below; declared here because TableRows makes it a friend.
template <class... Cs, class S, class F>
void call_with_spans(S& storage, F& f, const Table& table,
                     const std::array<ComponentId, sizeof...(Cs)>& ids, std::uint32_t first,
                     std::uint32_t count);

}  // namespace detail

// The rows being iterated, for marking rows as changed: an optional first parameter of the function
// given to World::each. Valid during that call.
template <class... Cs>
class TableRows {
 public:
  // Marks rows [first, first + count) of the spans as changed in C, which the query must write.
  template <Component C>
  void mark_changed(std::size_t first, std::size_t count) const {
    static_assert(detail::kCount<C, Cs...> == 1, "only a component that the query writes changes");
    static_assert(is_tracked<C>(), "only a tracked component is marked");
    PSYGEN_ECS_ASSERT(first <= count_ && count <= count_ - first, "rows are within the spans");
    const detail::ComponentId id = storage_->find_id(detail::kComponentInfo<C>);
    detail::Storage::mark_range(storage_->record(id), table_->id(),
                                static_cast<std::uint32_t>(first_ + first),
                                static_cast<std::uint32_t>(count));
  }

 private:
  template <class... Ds, class S, class F>
  friend void detail::call_with_spans(S& storage, F& f, const detail::Table& table,
                                      const std::array<detail::ComponentId, sizeof...(Ds)>& ids,
                                      std::uint32_t first, std::uint32_t count);
  TableRows(detail::Storage& storage, const detail::Table& table, std::size_t first,
            std::size_t count)
      : storage_(&storage), table_(&table), first_(first), count_(count) {}

  detail::Storage* storage_;
  const detail::Table* table_;
  std::size_t first_;
  std::size_t count_;
};

namespace detail {

// Joins neighbouring rows of a table to runs; calls visit(table, first row, count) for each run.
template <class F>
class RunMerger {
 public:
  // Both arguments must outlive the merger.
  RunMerger(const Storage& storage, F& visit) : storage_(storage), visit_(visit) {}

  // Adds the next row. Visits the previous run if `at` does not continue it.
  void add(RowPlace at) {
    if (count_ > 0 && at.table == begin_.table && at.row == begin_.row + count_) {
      ++count_;
      return;
    }
    finish();
    begin_ = at;
    count_ = 1;
  }
  // Visits the last run. Call it once, after the last row.
  void finish() {
    if (count_ > 0) visit_(*storage_.tables()[begin_.table], begin_.row, count_);
  }

 private:
  const Storage& storage_;
  F& visit_;
  RowPlace begin_{0, 0};
  std::uint32_t count_ = 0;
};

// The most components that the filters of one query may name, and the number that one filter names.
inline constexpr std::size_t kMaxFilters = 8;
template <class F>
inline constexpr std::size_t kFilterSize = 0;
template <class... Cs>
inline constexpr std::size_t kFilterSize<With<Cs...>> = sizeof...(Cs);
template <class... Cs>
inline constexpr std::size_t kFilterSize<Without<Cs...>> = sizeof...(Cs);

// Selects the rows that a query visits. Made from the query's columns and filters, then walked
// once.
class RowFilter {
 public:
  // Rows must have (want) or lack (refuse) this component. A wanted component that the world does
  // not know matches nothing. At most kMaxFilters calls of each for sparse components.
  void want(const Storage& storage, const ComponentInfo& info);
  void refuse(const Storage& storage, const ComponentInfo& info);

  // Adds one filter of a query.
  template <class... Cs>
  void add(const Storage& storage, With<Cs...>) {
    (want(storage, kComponentInfo<Cs>), ...);
  }
  template <class... Cs>
  void add(const Storage& storage, Without<Cs...>) {
    (refuse(storage, kComponentInfo<Cs>), ...);
  }

  // Calls visit(table, first row, count) for every run of matching rows. Runs are not empty.
  template <class F>
  void each_run(const Storage& storage, F&& visit) const;

 private:
  static constexpr std::size_t kMaxSets = kMaxFilters;
  bool fits(const Table& table) const {
    return table.signature().includes(wanted_) && !table.signature().intersects(unwanted_);
  }
  bool fits(Entity entity) const;
  template <class F>
  void each_run_of_members(const Storage& storage, F& visit) const;
  template <class F>
  void each_run_of_rows(const Table& table, F& visit) const;

  Signature wanted_;
  Signature unwanted_;
  std::array<const SparseSet*, kMaxSets> with_{};
  std::array<const SparseSet*, kMaxSets> without_{};
  std::size_t with_count_ = 0;
  std::size_t without_count_ = 0;
  bool impossible_ = false;
};

template <class F>
void RowFilter::each_run(const Storage& storage, F&& visit) const {
  if (impossible_) return;
  if (with_count_ > 0) return each_run_of_members(storage, visit);
  for (const auto& table : storage.tables()) {
    if (table == nullptr || table->rows() == 0 || !fits(*table)) continue;
    if (without_count_ == 0) {
      visit(*table, 0U, table->rows());
    } else {
      each_run_of_rows(*table, visit);
    }
  }
}

// Follows the members of the smallest set to their tables. Neighbours there form one run.
template <class F>
void RowFilter::each_run_of_members(const Storage& storage, F& visit) const {
  const SparseSet* smallest = with_[0];
  for (std::size_t i = 1; i < with_count_; ++i) {
    if (with_[i]->rows().rows() < smallest->rows().rows()) smallest = with_[i];
  }
  const std::span<const Entity> members(smallest->rows().entities(), smallest->rows().rows());
  RunMerger runs(storage, visit);
  for (const Entity member : members) {
    const RowPlace at = storage.directory().place_of(storage.slots()[member.index].location);
    if (fits(*storage.tables()[at.table]) && fits(member)) runs.add(at);
  }
  runs.finish();
}

// Looks up every row's entity in the sparse sets.
template <class F>
void RowFilter::each_run_of_rows(const Table& table, F& visit) const {
  const Entity* entities = table.entities();
  for (std::uint32_t row = 0; row < table.rows();) {
    const std::uint32_t first = row;
    while (row < table.rows() && fits(entities[row]))
      ++row;
    if (row > first) visit(table, first, row - first);
    ++row;
  }
}

// Calls visit(table, first row, count) for every maximal run of living `entities` that are
// neighbours in a table. Keeps their order. O(entities).
template <class F>
void each_run_of(const Storage& storage, std::span<const Entity> entities, F&& visit) {
  RunMerger runs(storage, visit);
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + kPrefetchAhead < entities.size())
      storage.slots().prefetch(entities[i + kPrefetchAhead]);
    if (const Slot* slot = storage.living(entities[i]))
      runs.add(storage.directory().place_of(slot->location));
  }
  runs.finish();
}

// Calls f(entities, spans of Cs...), or f(TableRows<Cs...>, entities, spans of Cs...), for one run.
template <class... Cs, class S, class F>
void call_with_spans(S& storage, F& f, const Table& table,
                     const std::array<ComponentId, sizeof...(Cs)>& ids, std::uint32_t first,
                     std::uint32_t count) {
  const std::span<const Entity> entities(table.entities() + first, count);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto column = [&]<class C>(std::type_identity<C>, ComponentId id) {
      return std::span<C>(rows_of<std::remove_const_t<C>>(table.column_data(id)) + first, count);
    };
    if constexpr (std::is_invocable_v<F&, std::span<const Entity>, std::span<Cs>...>) {
      f(entities, column(std::type_identity<Cs>{}, ids[I])...);
    } else {
      f(TableRows<Cs...>(storage, table, first, count), entities,
        column(std::type_identity<Cs>{}, ids[I])...);
    }
  }
  (std::make_index_sequence<sizeof...(Cs)>{});
}

}  // namespace detail
}  // namespace psygen::ecs
