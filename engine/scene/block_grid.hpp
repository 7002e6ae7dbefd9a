// The window of blocks around the camera that exist as entities: a square of side × side blocks in
// a table addressed modulo a power of two, so that moving the window touches only what enters and
// leaves, and block indices may wrap at 2^32. Holds handles, not data. Main thread.
#pragma once

#include <cstdint>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"

namespace psygen::scene {

class BlockGrid {
 public:
  // A window of 2·radius + 1 cells a side.
  explicit BlockGrid(std::uint32_t radius = 0);

  std::uint32_t radius() const { return radius_; }
  std::uint32_t side() const { return 2 * radius_ + 1; }
  core::BlockCoord centre() const { return centre_; }
  void set_centre(core::BlockCoord centre) { centre_ = centre; }

  // The block at window position (column, row), 0 … side − 1 each.
  core::BlockCoord coord_at(std::uint32_t column, std::uint32_t row) const;
  // row · side + column of a block of the window.
  std::size_t window_index(core::BlockCoord coord) const;
  // True if the block lies in the window.
  bool contains(core::BlockCoord coord) const;
  // The entity kept for a block of the window; null if there is none.
  ecs::Entity& entity_of(core::BlockCoord coord);
  ecs::Entity entity_of(core::BlockCoord coord) const;

 private:
  std::size_t cell_of(core::BlockCoord coord) const;

  std::uint32_t radius_;
  std::uint32_t mask_;
  core::BlockCoord centre_;
  std::vector<ecs::Entity> cells_;
};

}  // namespace psygen::scene
