#include "engine/scene/nodes/grid.hpp"

#include <bit>

#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {

NodeGrid::NodeGrid(std::uint8_t level, std::uint32_t radius)
    : level_(level),
      radius_(radius),
      max_radius_(radius),
      mask_(std::bit_ceil(2 * radius + 1) - 1),
      centre_{{}, level},
      cells_(std::size_t{mask_ + 1} * (mask_ + 1)) {}

// Position in the window along one axis; above side − 1 for nodes outside. Coordinates have 32 −
// level bits.
std::uint32_t NodeGrid::column_of(std::int32_t index, std::int32_t centre) const {
  const std::uint32_t column =
      static_cast<std::uint32_t>(index) - static_cast<std::uint32_t>(centre) + radius_;
  return column & (UINT32_MAX >> level_);
}

bool NodeGrid::contains(core::BlockCoord coord) const {
  return column_of(coord.x, centre_.coord.x) <= 2 * radius_ &&
         column_of(coord.z, centre_.coord.z) <= 2 * radius_;
}

visibility::NodeCoord NodeGrid::node_at(std::uint32_t column, std::uint32_t row) const {
  const auto radius = static_cast<std::int32_t>(radius_);
  return visibility::neighbour_of(centre_, static_cast<std::int32_t>(column) - radius,
                                  static_cast<std::int32_t>(row) - radius);
}

std::size_t NodeGrid::window_index(core::BlockCoord coord) const {
  return std::size_t{column_of(coord.z, centre_.coord.z)} * side() +
         column_of(coord.x, centre_.coord.x);
}

std::size_t NodeGrid::cell_of(core::BlockCoord coord) const {
  return std::size_t{static_cast<std::uint32_t>(coord.z) & mask_} * (mask_ + 1) +
         (static_cast<std::uint32_t>(coord.x) & mask_);
}

ecs::Entity& NodeGrid::entity_of(core::BlockCoord coord) {
  return cells_[cell_of(coord)];
}
ecs::Entity NodeGrid::entity_of(core::BlockCoord coord) const {
  return cells_[cell_of(coord)];
}

std::vector<NodeGrid> node_grids(const SceneSettings& settings, const WorldFacts& facts) {
  std::vector<NodeGrid> grids;
  for (std::size_t k = 0; k < facts.levels.size(); ++k)
    grids.emplace_back(static_cast<std::uint8_t>(k),
                       largest_radius(facts.world, facts.levels, settings, k));
  return grids;
}

}  // namespace psygen::scene
