#include "ecs/children.hpp"

#include <algorithm>
#include <bit>

#include "ecs/check.hpp"

namespace psygen::ecs::detail {
namespace {

std::size_t class_of(std::size_t count) {
  return static_cast<std::size_t>(std::bit_width(std::bit_ceil(count)) - 1);
}

}  // namespace

void ChildLists::assign(Children& list, std::span<const Entity> handles) {
  const std::size_t old_class = class_of(list.count_);
  const std::size_t new_class = class_of(handles.size());
  const bool keeps_range = list.count_ > 0 && !handles.empty() && old_class == new_class;
  const bool had_range = list.count_ > 0;
  const std::uint32_t old_first = list.first_;
  if (!handles.empty() && !keeps_range) {
    if (free_[new_class].empty()) {
      const std::size_t length = std::size_t{1} << new_class;
      if (handles_.size() + length > UINT32_MAX) give_up("more than four billion children");
      list.first_ = static_cast<std::uint32_t>(handles_.size());
      handles_.resize(handles_.size() + length);
    } else {
      list.first_ = free_[new_class].back();
      free_[new_class].pop_back();
    }
  }
  list.count_ = static_cast<std::uint32_t>(handles.size());
  std::ranges::copy(handles, handles_.begin() + list.first_);
  // Last, because a range that is free while its list still names it could be issued twice.
  if (had_range && !keeps_range) free_[old_class].push_back(old_first);
}

}  // namespace psygen::ecs::detail
