// The finest mesh of a block in squares of cells ("tiles"), so that near the camera a part of a
// block is drawn finely and the rest of it with the cells of the next coarser level. One index list
// over the vertices of level 0, of which parts are drawn. Which ones is the caller's choice; the
// vertices are terrain.cpp's.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/geometry_memory.hpp"

namespace psygen::models {

class TerrainTiles {
 public:
  static constexpr int kMostPerSide = 3;

  // Of blocks with `size` vertices a side, kMinTerrainSize … kMaxTerrainSize.
  explicit TerrainTiles(int size);

  // Tiles along each side of the block: 3, or as many as the coarser level has cells.
  int per_side() const { return per_side_; }
  // Where column or row i begins, in cells from the block's corner; of per_side(), where the block
  // ends.
  int first_cell(int i) const { return first_cell_[static_cast<std::size_t>(i)]; }

  enum class Form : std::uint8_t {
    kFine,    // every cell
    kRimmed,  // cells of the coarser level that share every vertex of the tile's border with fine
              // tiles
    kCoarse,  // cells of the coarser level
  };
  core::IndexPart tile(int column, int row, Form form) const;
  // All four skirts of the block, as in TerrainGrid.
  core::IndexPart skirts() const { return {tile_first(tiles() * kForms), skirt_indices_}; }

  std::uint32_t index_count() const { return skirts().first + skirt_indices_; }
  // Writes index_count() indices, counter-clockwise seen from above; cells of either size are cut
  // from (x, z + 1) to (x + 1, z).
  void write_indices(std::span<std::uint16_t> out) const;

 private:
  static constexpr std::uint32_t kForms = 3;
  struct Rect;  // of cells

  std::uint32_t tiles() const { return static_cast<std::uint32_t>(per_side_ * per_side_); }
  Rect rect_of(int column, int row) const;
  std::uint32_t index_count_of(const Rect& rect, Form form) const;
  std::uint32_t tile_first(std::uint32_t tile_form) const { return firsts_[tile_form]; }

  int size_, stride_;  // vertices a side; cells along the side of one of the coarser level
  int per_side_;
  std::array<int, kMostPerSide + 1> first_cell_{};
  std::array<std::uint32_t, kForms * kMostPerSide * kMostPerSide + 1> firsts_{};
  std::uint32_t skirt_indices_;
};

}  // namespace psygen::models
