// The finest mesh of a block as tiles (grid.hpp) of two kinds. Near the camera, a part of a block
// is drawn finely and the rest with the cells of the next coarser level. One index list over the
// vertices of level 0 has all tiles, and the renderer draws parts of it. The caller chooses the
// parts; terrain.cpp makes the vertices. Immutable, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/geometry_memory.hpp"
#include "engine/models/terrain/grid.hpp"

namespace psygen::models {

// The index list of one block size.
class TerrainTiles {
 public:
  // For blocks with `size` vertices per side, kMinTerrainSize … kMaxTerrainSize.
  explicit TerrainTiles(int size);

  // The grid of level 0: its vertices and the lines between its tiles.
  const TerrainGrid& grid() const { return grid_; }

  // Sides of a tile, as bits: towards −z, +x, +z and −x.
  enum Sides : std::uint8_t { kNone = 0, kNorth = 1, kEast = 2, kSouth = 4, kWest = 8, kAll = 15 };

  // A tile with every cell. `column` and `row` are below grid().tiles_per_side().
  core::IndexPart fine(int column, int row) const { return part(0, column, row); }
  // The tile with cells of the coarser level. On the `divided` sides it has every vertex of level
  // 0, to match fine neighbours; on the others only those of the coarser level. Two tiles that
  // share a side must have the same vertices on it, or single pixels of sky would show through.
  core::IndexPart coarse(int column, int row, std::uint8_t divided) const {
    return part(1U + divided, column, row);
  }
  // The skirt of a side, numbered as in TerrainGrid.
  core::IndexPart skirt(int side) const;

  // Length of the whole list.
  std::uint32_t index_count() const { return skirt(3).first + skirt(3).count; }
  // Writes index_count() indices, counter-clockwise seen from above. Cells of both sizes are cut
  // from (x, z + 1) to (x + 1, z), in units of their side. Allocates temporary memory.
  void write_indices(std::span<std::uint16_t> out) const;

 private:
  static constexpr std::uint32_t kForms = 1 + kAll + 1;  // 0: fine; else 1 + the divided sides
  struct Rect;                                           // of cells

  std::uint32_t tiles() const {
    return static_cast<std::uint32_t>(grid_.tiles_per_side() * grid_.tiles_per_side());
  }
  Rect rect_of(int column, int row) const;
  std::uint32_t index_count_of(const Rect& rect, std::uint32_t form) const;
  core::IndexPart part(std::uint32_t form, int column, int row) const;

  TerrainGrid grid_;
  int stride_;  // cells along one side of a coarser cell
  // First index of each tile in each form, then that of the skirts.
  std::array<std::uint32_t, kForms * kMaxTilesPerSide * kMaxTilesPerSide + 1> firsts_{};
};

}  // namespace psygen::models
