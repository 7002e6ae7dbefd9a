// Type information of a component: its name, its storage, change tracking, and functions that
// build, move and destroy batches of rows. There is one constant table per type, and its address is
// the type's identity. Users specialise ComponentTraits (fields.hpp); the rest is internal.
// Constants and pure functions over rows: no state, any thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>
#include <type_traits>
#include <utility>

#include "ecs/fields.hpp"

namespace psygen::ecs {

// Any movable value type, aligned to at most 64 bytes. Moving and destroying must not throw;
// constructing may.
template <class C>
concept Component =
    std::is_object_v<C> && std::is_same_v<C, std::remove_cv_t<C>> && !std::is_array_v<C> &&
    std::is_default_constructible_v<C> && std::is_nothrow_move_constructible_v<C> &&
    std::is_nothrow_destructible_v<C> && alignof(C) <= 64;

// True if changes of C are tracked: ComponentTraits<C>::tracked, by default false.
template <class C>
constexpr bool is_tracked() {
  if constexpr (requires { ComponentTraits<C>::tracked; }) return ComponentTraits<C>::tracked;
  return false;
}

// True if C is stored in a sparse set: ComponentTraits<C>::sparse, by default false.
template <class C>
constexpr bool is_sparse() {
  if constexpr (requires { ComponentTraits<C>::sparse; }) return ComponentTraits<C>::sparse;
  return false;
}

namespace detail {

// The qualified name of C as this compiler spells it. Static storage.
template <class C>
constexpr std::string_view type_name() {
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.find("C = ") + 4);
  const std::size_t others = text.rfind("; std::string_view");  // g++ also lists aliases here
  return text.substr(0, others != std::string_view::npos ? others : text.rfind(']'));
}

}  // namespace detail

// ComponentTraits<C>::name, by default the compiler's name of the type. Static storage.
template <class C>
constexpr std::string_view component_name() {
  if constexpr (requires { ComponentTraits<C>::name; }) return ComponentTraits<C>::name;
  return detail::type_name<C>();
}

namespace detail {

// Moves row `from` to row `to`. `to` holds no object before the move, `from` holds none after it.
struct RowMove {
  std::uint32_t to;
  std::uint32_t from;
};

// Number of elements by which loops over handles and moves prefetch ahead.
inline constexpr std::size_t kPrefetchAhead = 16;

// A component type without its C++ type: sizes, flags and functions over rows of its column.
// `column` is the address of row 0; rows are `size_bytes` apart.
struct ComponentInfo {
  std::string_view name;
  std::size_t size_bytes;
  std::size_t alignment;
  bool tracked;
  bool sparse;
  const TypeDescription* (*describe)();  // returns null if the type lists no fields
  // Value-initialises rows [first, first + count). `fresh` says that their memory reads as zero. If
  // a constructor throws, none of these rows holds an object.
  void (*construct)(std::byte* column, std::size_t first, std::size_t count, bool fresh);
  // Both destroy objects: those of [first, first + count), or of the `count` listed rows. Null for
  // types with trivial destructors.
  void (*destroy_range)(std::byte* column, std::size_t first, std::size_t count);
  void (*destroy_rows)(std::byte* column, const std::uint32_t* rows, std::size_t count);
  // Performs `count` moves between rows of one column.
  void (*relocate_within)(std::byte* column, const RowMove* moves, std::size_t count);
  // Moves the listed rows of `source`, in this order, to rows first, first + 1, ... of `target`.
  void (*relocate_into)(std::byte* target, std::size_t first, std::byte* source,
                        const std::uint32_t* rows, std::size_t count);
};

// The column as an array of C. Only rows that hold objects may be read.
template <class C>
C* rows_of(std::byte* column) {
  return std::launder(reinterpret_cast<C*>(column));
}

// Moves the object at `from` to `to`, which holds none. `from` holds none afterwards. The two rows
// differ.
template <class C>
void relocate(C* to, C* from) {
  if constexpr (std::is_trivially_copyable_v<C>) {
    std::memcpy(static_cast<void*>(to), static_cast<const void*>(from), sizeof(C));
  } else {
    ::new (static_cast<void*>(to)) C(std::move(*from));
    std::destroy_at(from);
  }
}

// ComponentInfo::construct for C. Trivially copyable rows are copies of one value-initialised row.
// If that row is all zeros, this is one memset, or nothing at all on fresh memory.
template <class C>
void construct_rows(std::byte* column, std::size_t first, std::size_t count, bool fresh) {
  C* rows = reinterpret_cast<C*>(column) + first;
  constexpr std::size_t kLargestModel = 4096;  // bytes on the stack
  if constexpr (std::is_trivially_copyable_v<C> && sizeof(C) <= kLargestModel) {
    alignas(C) std::byte model[sizeof(C)]{};
    ::new (static_cast<void*>(model)) C();
    const bool zero =
        std::all_of(model, model + sizeof(C), [](std::byte b) { return b == std::byte{0}; });
    if (!zero) {
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(static_cast<void*>(rows + i), model, sizeof(C));
      }
    } else if (!fresh) {
      std::memset(static_cast<void*>(rows), 0, count * sizeof(C));
    }
  } else {
    std::uninitialized_value_construct_n(rows, count);
  }
}

// ComponentInfo::destroy_range for C.
template <class C>
void destroy_range_of(std::byte* column, std::size_t first, std::size_t count) {
  std::destroy_n(rows_of<C>(column) + first, count);
}

// ComponentInfo::destroy_rows for C.
template <class C>
void destroy_rows_of(std::byte* column, const std::uint32_t* rows, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    std::destroy_at(rows_of<C>(column) + rows[i]);
}

// ComponentInfo::relocate_within for C.
template <class C>
void relocate_within_column(std::byte* column, const RowMove* moves, std::size_t count) {
  C* rows = rows_of<C>(column);
  const std::size_t far = count > kPrefetchAhead ? count - kPrefetchAhead : 0;
  for (std::size_t i = 0; i < far; ++i) {
    __builtin_prefetch(rows + moves[i + kPrefetchAhead].to, 1);
    relocate(rows + moves[i].to, rows + moves[i].from);
  }
  for (std::size_t i = far; i < count; ++i)
    relocate(rows + moves[i].to, rows + moves[i].from);
}

// ComponentInfo::relocate_into for C.
template <class C>
void relocate_into_column(std::byte* target, std::size_t first, std::byte* source,
                          const std::uint32_t* rows, std::size_t count) {
  C* to = reinterpret_cast<C*>(target) + first;
  C* from = rows_of<C>(source);
  for (std::size_t i = 0; i < count; ++i) {
    if (i + kPrefetchAhead < count) __builtin_prefetch(from + rows[i + kPrefetchAhead]);
    relocate(to + i, from + rows[i]);
  }
}

// The table of C. Its address identifies C throughout the program.
template <Component C>
inline constexpr ComponentInfo kComponentInfo{
    component_name<C>(),
    sizeof(C),
    alignof(C),
    is_tracked<C>(),
    is_sparse<C>(),
    describe_component<C>,
    construct_rows<C>,
    std::is_trivially_destructible_v<C> ? nullptr : destroy_range_of<C>,
    std::is_trivially_destructible_v<C> ? nullptr : destroy_rows_of<C>,
    relocate_within_column<C>,
    relocate_into_column<C>};

}  // namespace detail
}  // namespace psygen::ecs
