#include "engine/models/terrain/grid.hpp"

#include <algorithm>

#include "engine/core/assert.hpp"

namespace psygen::models {
namespace {

// Two rows of vertices of this many cells are 32 vertices, the number that GPUs keep after shading.
// In wider strips every vertex would be shaded twice.
constexpr int kStripCells = 15;

}  // namespace

std::array<int, kTerrainLevels> terrain_strides(int size) {
  std::array<int, 8> factors{};  // 127 < 2^7
  int count = 0;
  int rest = size - 1;
  for (int f = 2; rest > 1; ++f) {
    for (; rest % f == 0; rest /= f)
      factors[static_cast<std::size_t>(count++)] = f;
  }
  for (; count > kTerrainLevels - 1; --count) {
    const int product = factors[0] * factors[1];
    int at = 2;
    for (; at < count && factors[static_cast<std::size_t>(at)] < product; ++at)
      factors[static_cast<std::size_t>(at - 2)] = factors[static_cast<std::size_t>(at)];
    factors[static_cast<std::size_t>(at - 2)] = product;
    for (; at < count; ++at)
      factors[static_cast<std::size_t>(at - 1)] = factors[static_cast<std::size_t>(at)];
  }
  std::array<int, kTerrainLevels> strides{1};
  for (int level = 1; level < kTerrainLevels; ++level) {
    const auto l = static_cast<std::size_t>(level);
    strides[l] = strides[l - 1] * (level <= count ? factors[l - 1] : 1);
  }
  return strides;
}

TerrainGrid::TerrainGrid(int size_at_level_0, int level_stride, int tile_step)
    : size(size_at_level_0), stride(level_stride), n((size - 1) / stride + 1) {
  const int steps = (n - 1) / tile_step;
  tiles_ = std::min(steps, kMaxTilesPerSide);
  for (int i = 0; i <= tiles_; ++i)
    tile_lines_[static_cast<std::size_t>(i)] = steps * i / tiles_ * tile_step;
}

TerrainGrid::TerrainGrid(int size_at_level_0, int level)
    : TerrainGrid(size_at_level_0,
                  terrain_strides(size_at_level_0)[static_cast<std::size_t>(level)],
                  level == 0 ? terrain_strides(size_at_level_0)[1] : 1) {}

TerrainGrid TerrainGrid::of_index_list(std::uint32_t id) {
  const int size = static_cast<int>((id >> 8) & 0xFFFFU);
  const int stride = static_cast<int>(id & 0xFFU);
  PSYGEN_CHECK(id >> 24 == 1 && size >= 2 && stride >= 1 && (size - 1) % stride == 0,
               "the index list is one that mesh_size() named");
  return {size, stride, stride == 1 ? terrain_strides(size)[1] : 1};
}

std::uint32_t TerrainGrid::border_vertex(std::uint32_t k) const {
  const auto last = static_cast<std::uint32_t>(n - 1);
  const auto width = static_cast<std::uint32_t>(n);
  const std::uint32_t along = k % last;
  switch (k / last) {
    case 0:
      return along;
    case 1:
      return along * width + last;
    case 2:
      return last * width + last - along;
    default:
      return (last - along) * width;
  }
}

core::IndexPart TerrainGrid::tile(int column, int row) const {
  PSYGEN_ASSERT(column >= 0 && column < tiles_per_side() && row >= 0 && row < tiles_per_side(),
                "the grid has such a tile");
  const int above = tile_line(row), deep = tile_line(row + 1) - above;
  const int left = tile_line(column), wide = tile_line(column + 1) - left;
  return {static_cast<std::uint32_t>(6 * (above * (n - 1) + deep * left)),
          static_cast<std::uint32_t>(6 * deep * wide)};
}

core::IndexPart TerrainGrid::skirt(int side) const {
  PSYGEN_ASSERT(side >= 0 && side < 4, "there are four sides");
  const auto along = static_cast<std::uint32_t>(6 * (n - 1));
  return {3 * surface_triangles() + static_cast<std::uint32_t>(side) * along, along};
}

void TerrainGrid::write_indices(std::span<std::uint16_t> out) const {
  PSYGEN_CHECK(out.size() == triangles() * 3, "the span has exactly the size of the list");
  const auto width = static_cast<std::uint32_t>(n);
  std::size_t at = 0;
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c})
      out[at++] = static_cast<std::uint16_t>(v);
  };
  const int tiles = tiles_per_side() * tiles_per_side();
  for (int tile = 0; tile < tiles; ++tile) {
    const int column = tile % tiles_per_side(), row = tile / tiles_per_side();
    const int left = tile_line(column), wide = tile_line(column + 1) - left;
    const int strips = (wide + kStripCells - 1) / kStripCells;
    for (int strip = 0; strip < strips; ++strip) {
      for (int z = tile_line(row); z < tile_line(row + 1); ++z) {
        for (int x = left + wide * strip / strips; x < left + wide * (strip + 1) / strips; ++x) {
          const auto v = static_cast<std::uint32_t>(z * n + x);
          triangle(v, v + width, v + 1);
          triangle(v + 1, v + width, v + width + 1);
        }
      }
    }
  }
  const std::uint32_t border = border_vertices();
  for (std::uint32_t k = 0; k < border; ++k) {
    const std::uint32_t next = (k + 1) % border;
    const std::uint32_t a = border_vertex(k), b = border_vertex(next);
    const std::uint32_t a_low = surface_vertices() + k, b_low = surface_vertices() + next;
    triangle(b, b_low, a_low);
    triangle(b, a_low, a);
  }
}

}  // namespace psygen::models
