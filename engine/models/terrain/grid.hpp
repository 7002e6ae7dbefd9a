// The topology of a terrain mesh: the vertices of each level, their order in the vertex array, and
// the index list that all blocks of one size share. It has no heights (terrain.cpp makes them).
// Plain values, usable from any thread. docs/models.md, "Mesh".
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/geometry_memory.hpp"

namespace psygen::models {

inline constexpr int kTerrainLevels = 4;
inline constexpr int kMinTerrainSize = 4;    // vertices per side at level 0
inline constexpr int kMaxTerrainSize = 128;  // grid indices have seven bits
inline constexpr int kMaxTilesPerSide = 3;

// Grid distance between neighbouring vertices of each level: 1, then growing by whole factors up to
// size − 1. So the vertices of a level are a subset of those of the level before. The factors are
// the prime factors of size − 1, smallest first; the smallest two are multiplied while there are
// more than three. 63 cells give 1, 3, 9, 63. With fewer factors, the last levels are the same.
std::array<int, kTerrainLevels> terrain_strides(int size);

// One level of a block: n × n surface vertices, row by row (z outer, x inner), then 4·(n − 1) skirt
// vertices. These are the twins of the border vertices, in the order of border_vertex().
struct TerrainGrid {
  int size;    // vertices per side at level 0
  int stride;  // of this level
  int n;       // vertices per side of this level

  // kMinTerrainSize <= size_at_level_0 <= kMaxTerrainSize, 0 <= level < kTerrainLevels.
  TerrainGrid(int size_at_level_0, int level);
  // Sizes of the mesh. triangles() includes the skirts, two per border vertex.
  std::uint32_t surface_vertices() const { return static_cast<std::uint32_t>(n * n); }
  std::uint32_t border_vertices() const { return static_cast<std::uint32_t>(4 * (n - 1)); }
  std::uint32_t surface_triangles() const {
    return static_cast<std::uint32_t>(2 * (n - 1) * (n - 1));
  }
  std::uint32_t triangles() const { return surface_triangles() + 2 * border_vertices(); }
  // The surface vertex that is k-th along the border, from (0, 0) along +x, +z, −x and −z.
  // k < border_vertices().
  std::uint32_t border_vertex(std::uint32_t k) const;

  // Tiles are rectangles of cells that can be drawn separately: 3 along each side, or as many as
  // there are cells. At level 0 the tile lines lie on vertices of level 1.
  int tiles_per_side() const { return tiles_; }
  // The vertex along a side where column or row i of the tiles begins, or the last vertex for
  // i = tiles_per_side().
  int tile_line(int i) const { return tile_lines_[static_cast<std::size_t>(i)]; }

  // The id of the index list of this (size, stride). Never 0 and never that of a rock.
  std::uint32_t index_list() const {
    return (1U << 24) | static_cast<std::uint32_t>(size << 8) | static_cast<std::uint32_t>(stride);
  }
  // Returns the grid of an id from index_list(). Other ids fail an assertion, also in release.
  static TerrainGrid of_index_list(std::uint32_t id);

  // Writes triangles() · 3 indices, counter-clockwise seen from outside. The surface comes first,
  // tile by tile, in strips of at most 15 cells, row by row. Each cell is cut from (x, z + 1) to
  // (x + 1, z). The skirts follow.
  void write_indices(std::span<std::uint16_t> out) const;
  // Return the part of that list with one tile, and the part with the skirt of one side. The sides
  // are 0 at z = 0, 1 at the greatest x, 2 at the greatest z, 3 at x = 0.
  core::IndexPart tile(int column, int row) const;
  core::IndexPart skirt(int side) const;

 private:
  // `tile_step`: vertices from one possible tile line to the next.
  TerrainGrid(int size_at_level_0, int level_stride, int tile_step);

  int tiles_;
  std::array<int, kMaxTilesPerSide + 1> tile_lines_{};
};

}  // namespace psygen::models
