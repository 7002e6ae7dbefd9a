// The topology of a terrain mesh: which vertices a level has, where they lie in the vertex array,
// and the index list that all blocks of one size share. Heights are terrain.cpp's subject.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/geometry_memory.hpp"

namespace psygen::models {

inline constexpr int kTerrainLevels = 4;
inline constexpr int kMinTerrainSize = 4;
inline constexpr int kMaxTerrainSize = 128;  // grid indices have seven bits
inline constexpr int kMostTilesPerSide = 3;

// Grid distance between neighbouring vertices of each level: 1, then growing by whole factors until
// size − 1, so that a level's vertices are a subset of the level before. The prime factors of
// size − 1, smallest first, the smallest two multiplied while there are more than three. 63 gives
// 1, 3, 9, 63. Where there are fewer factors than levels, the last levels are the same.
std::array<int, kTerrainLevels> terrain_strides(int size);

// One level of a block: n × n surface vertices, row by row (z outer, x inner), then 4·(n − 1) skirt
// vertices, the twins of the border in the order of border_vertex().
struct TerrainGrid {
  int size;    // vertices per side at level 0
  int stride;  // of this level
  int n;       // vertices per side of this level

  TerrainGrid(int size_at_level_0, int level);
  std::uint32_t surface_vertices() const { return static_cast<std::uint32_t>(n * n); }
  std::uint32_t border_vertices() const { return static_cast<std::uint32_t>(4 * (n - 1)); }
  std::uint32_t surface_triangles() const {
    return static_cast<std::uint32_t>(2 * (n - 1) * (n - 1));
  }
  std::uint32_t triangles() const { return surface_triangles() + 2 * border_vertices(); }
  // The k-th surface vertex of the border, from (0, 0) along +x, +z, −x and −z.
  std::uint32_t border_vertex(std::uint32_t k) const;

  // Squares of cells ("tiles"), of which a part can be drawn: 3 along each side, or as many as
  // there are cells. At level 0 they are divided as the cells of level 1 are.
  int tiles_per_side() const { return tiles_; }
  // The vertex of a side where column or row i of the tiles begins; of tiles_per_side(), its last.
  int tile_line(int i) const { return tile_lines_[static_cast<std::size_t>(i)]; }

  // Names the index list of this (size, stride); never 0 and never a rock's.
  std::uint32_t index_list() const {
    return (1U << 24) | static_cast<std::uint32_t>(size << 8) | static_cast<std::uint32_t>(stride);
  }
  static TerrainGrid of_index_list(std::uint32_t id);

  // Writes triangles() · 3 indices, counter-clockwise seen from outside: the surface tile by tile,
  // in strips of at most 15 cells row by row, each cell cut from (x, z + 1) to (x + 1, z), then the
  // skirts.
  void write_indices(std::span<std::uint16_t> out) const;
  // Where a tile lies in that list, and the skirt of a side: 0 at z = 0, then at the greatest x, at
  // the greatest z, at x = 0.
  core::IndexPart tile(int column, int row) const;
  core::IndexPart skirt(int side) const;

 private:
  // `tile_step`: vertices from one possible tile line to the next.
  TerrainGrid(int size_at_level_0, int level_stride, int tile_step);

  int tiles_;
  std::array<int, kMostTilesPerSide + 1> tile_lines_{};
};

}  // namespace psygen::models
