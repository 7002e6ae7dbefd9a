// The finest mesh of a block in tiles (grid.hpp) of two kinds, so that near the camera a
// part of a block is drawn finely and the rest of it with the cells of the next coarser level. One
// index list over the vertices of level 0, of which parts are drawn. Which ones is the caller's
// choice; the vertices are terrain.cpp's.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/geometry_memory.hpp"
#include "engine/models/terrain/grid.hpp"

namespace psygen::models {

class TerrainTiles {
 public:
  // Of blocks with `size` vertices a side, kMinTerrainSize … kMaxTerrainSize.
  explicit TerrainTiles(int size);

  // Of the vertices, and of the tiles in their fine form.
  const TerrainGrid& grid() const { return grid_; }

  // Sides of a tile, to be added: towards −z, +x, +z and −x.
  enum Sides : std::uint8_t { kNone = 0, kNorth = 1, kEast = 2, kSouth = 4, kWest = 8, kAll = 15 };

  // Every cell of a tile.
  core::IndexPart fine(int column, int row) const { return part(0, column, row); }
  // Cells of the coarser level, that share every vertex of the `divided` sides with fine tiles and
  // only those of the coarser level on the others: no side is shared with other vertices on it than
  // the neighbour's, through which the sky would be seen in single pixels.
  core::IndexPart coarse(int column, int row, std::uint8_t divided) const {
    return part(1U + divided, column, row);
  }
  // The skirt of a side, as in TerrainGrid.
  core::IndexPart skirt(int side) const;

  std::uint32_t index_count() const { return skirt(3).first + skirt(3).count; }
  // Writes index_count() indices, counter-clockwise seen from above; cells of either size are cut
  // from (x, z + 1) to (x + 1, z).
  void write_indices(std::span<std::uint16_t> out) const;

 private:
  static constexpr std::uint32_t kForms = 1 + kAll + 1;  // 0: fine; 1 + the sides that are divided
  struct Rect;                                           // of cells

  std::uint32_t tiles() const {
    return static_cast<std::uint32_t>(grid_.tiles_per_side() * grid_.tiles_per_side());
  }
  Rect rect_of(int column, int row) const;
  std::uint32_t index_count_of(const Rect& rect, std::uint32_t form) const;
  core::IndexPart part(std::uint32_t form, int column, int row) const;

  TerrainGrid grid_;
  int stride_;  // cells along the side of one of the coarser level
  // Where each tile in each form begins; then where the skirts do.
  std::array<std::uint32_t, kForms * kMostTilesPerSide * kMostTilesPerSide + 1> firsts_{};
};

}  // namespace psygen::models
