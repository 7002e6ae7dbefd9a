// Parents and children. A parent has a column `Children`, 8 bytes that name a contiguous range of
// handles, so a thousand parents are a thousand rows of one table. The world owns the lists, and
// frees a list when its parent dies or loses the component. Not a scene graph: children have no
// link to their parent and may have any components. Set with World::set_children, read with
// World::children.
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

// The component of a parent. Only World::set_children writes it. A new one is empty.
class Children {
 public:
  // Starts with an empty list. Movable because rows move; not copyable because a list has one
  // owner.
  Children() = default;
  Children(Children&&) = default;
  Children& operator=(Children&&) = delete;

  // Number of children in the list, dead ones included.
  std::uint32_t count() const { return count_; }

 private:
  friend class detail::ChildLists;
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
};
static_assert(sizeof(Children) == 8);

// Sets the name only: Children is neither tracked nor sparse, and snapshots write the list itself.
template <>
struct ComponentTraits<Children> {
  static constexpr std::string_view name = "Children";
};

namespace detail {

// All lists of one world in one array. Ranges are powers of two, so freed ranges fit again. Only
// the world's thread changes it.
class ChildLists {
 public:
  // Returns the handles of a list; empty if the list does not belong to this array. Valid until the
  // next assign.
  std::span<const Entity> of(const Children& list) const {
    if (list.count_ > handles_.size() || list.first_ > handles_.size() - list.count_) return {};
    return {handles_.data() + list.first_, list.count_};
  }
  // Replaces the list. `handles` must not belong to this array. Amortised O(handles). Ends the
  // program beyond four billion handles.
  void assign(Children& list, std::span<const Entity> handles);
  // Empties the list and frees its range.
  void release(Children& list) { assign(list, {}); }
  // Allocated bytes of the array, free ranges included.
  std::size_t committed_bytes() const { return handles_.capacity() * sizeof(Entity); }

 private:
  static constexpr std::size_t kClasses = 33;
  std::vector<Entity> handles_;
  std::array<std::vector<std::uint32_t>, kClasses> free_;  // by log2 of the length
};

}  // namespace detail
}  // namespace psygen::ecs
