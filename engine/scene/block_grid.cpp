#include "engine/scene/block_grid.hpp"

#include <bit>

namespace psygen::scene {
namespace {

std::int32_t wrapped_sum(std::int32_t a, std::int64_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

}  // namespace

BlockGrid::BlockGrid(std::uint32_t radius)
    : radius_(radius),
      mask_(std::bit_ceil(2 * radius + 1) - 1),
      cells_(std::size_t{mask_ + 1} * (mask_ + 1)) {}

bool BlockGrid::contains(core::BlockCoord coord) const {
  const auto within = [this](std::int32_t a, std::int32_t b) {
    return static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b) + radius_ <= 2 * radius_;
  };
  return within(coord.x, centre_.x) && within(coord.z, centre_.z);
}

core::BlockCoord BlockGrid::coord_at(std::uint32_t column, std::uint32_t row) const {
  return {wrapped_sum(centre_.x, std::int64_t{column} - radius_),
          wrapped_sum(centre_.z, std::int64_t{row} - radius_)};
}

std::size_t BlockGrid::window_index(core::BlockCoord coord) const {
  const auto place = [this](std::int32_t a, std::int32_t centre) {
    return static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(centre) + radius_;
  };
  return std::size_t{place(coord.z, centre_.z)} * side() + place(coord.x, centre_.x);
}

std::size_t BlockGrid::cell_of(core::BlockCoord coord) const {
  return std::size_t{static_cast<std::uint32_t>(coord.z) & mask_} * (mask_ + 1) +
         (static_cast<std::uint32_t>(coord.x) & mask_);
}

ecs::Entity& BlockGrid::entity_of(core::BlockCoord coord) {
  return cells_[cell_of(coord)];
}
ecs::Entity BlockGrid::entity_of(core::BlockCoord coord) const {
  return cells_[cell_of(coord)];
}

}  // namespace psygen::scene
