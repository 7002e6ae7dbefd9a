// Iteration: which tables have the wanted components, and the spans of each. One call per table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "ecs/storage.hpp"

namespace psygen::ecs {

// Says which components a table must not have: world.each<A>(f, Without<B>{}).
template <Component... Cs>
struct Without {};

namespace detail {

template <class... Cs>
inline constexpr std::array<QueryTerm, sizeof...(Cs)> kQueryTerms{
    QueryTerm{component_name<std::remove_const_t<Cs>>(), !std::is_const_v<Cs>}...};
template <class... Cs>
inline constexpr std::span<const QueryTerm> kQuery{kQueryTerms<Cs...>};

template <class C, class... Cs>
inline constexpr std::size_t kCount = (std::size_t{0} + ... + std::size_t{std::is_same_v<C, Cs>});
template <class... Cs>
inline constexpr bool kDistinct =
    ((kCount<std::remove_const_t<Cs>, std::remove_const_t<Cs>...> == 1) && ...);

}  // namespace detail

// The table that is being iterated, for marking rows as changed: an optional first parameter of the
// function given to World::each.
template <class... Cs>
class TableRows {
 public:
  // Rows [first, first + count) of the spans changed in C, which the query must write.
  template <Component C>
  void mark_changed(std::size_t first, std::size_t count) const {
    static_assert(detail::kCount<C, Cs...> == 1, "only a component that the query writes changes");
    static_assert(is_tracked<C>(), "only a tracked component is marked");
    PSYGEN_ECS_ASSERT(first <= table_->rows() && count <= table_->rows() - first,
                      "rows are within the spans");
    const detail::ComponentId id = storage_->find_id(detail::kComponentInfo<C>);
    detail::Storage::mark_range(storage_->record(id), table_->id(),
                                static_cast<std::uint32_t>(first),
                                static_cast<std::uint32_t>(count));
  }

 private:
  friend class World;
  TableRows(detail::Storage& storage, const detail::Table& table)
      : storage_(&storage), table_(&table) {}

  detail::Storage* storage_;
  const detail::Table* table_;
};

}  // namespace psygen::ecs
