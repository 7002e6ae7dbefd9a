// Parents and children without a difference in kind: a parent has a column `Children`, 8 bytes that
// name a contiguous range of handles; a thousand parents are a thousand rows of one table. The
// lists live in the world, which frees a list when its parent dies or loses the component. Children
// know nothing of it and may be of any kind. Set and read with World::set_children and children().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "ecs/entity.hpp"
#include "ecs/fields.hpp"

namespace psygen::ecs {

namespace detail {
class ChildLists;
}

// The component of a parent. Written by World::set_children only; a new one is empty.
class Children {
 public:
  Children() = default;
  Children(Children&&) = default;  // rows move; a list has one owner
  Children& operator=(Children&&) = delete;

  std::uint32_t count() const { return count_; }

 private:
  friend class detail::ChildLists;
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
};
static_assert(sizeof(Children) == 8);

template <>
struct ComponentTraits<Children> {
  static constexpr std::string_view name = "Children";
};

namespace detail {

// All lists of a world in one array. Ranges are powers of two, so that freed ones fit again.
class ChildLists {
 public:
  std::span<const Entity> of(const Children& list) const {
    if (list.count_ > handles_.size() || list.first_ > handles_.size() - list.count_) return {};
    return {handles_.data() + list.first_, list.count_};
  }
  // Replaces the list. `handles` may not lie in this array. Amortised O(handles).
  void assign(Children& list, std::span<const Entity> handles);
  void release(Children& list) { assign(list, {}); }
  std::size_t committed_bytes() const { return handles_.capacity() * sizeof(Entity); }

 private:
  static constexpr std::size_t kClasses = 33;
  std::vector<Entity> handles_;
  std::array<std::vector<std::uint32_t>, kClasses> free_;  // by log2 of the length
};

}  // namespace detail
}  // namespace psygen::ecs
