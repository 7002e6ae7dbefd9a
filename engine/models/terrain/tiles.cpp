#include "engine/models/terrain/tiles.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "engine/core/assert.hpp"

namespace psygen::models {

struct TerrainTiles::Rect {
  int x0, z0, x1, z1;
};

namespace {

// Writes triangles whose vertices are given as places in the grid.
class Writer {
 public:
  struct Place {
    int x, z;
  };

  Writer(int width, std::span<std::uint16_t> out) : width_(width), out_(out) {}

  void triangle(Place a, Place b, Place c) {
    for (const Place& p : {a, b, c})
      out_[at_++] = static_cast<std::uint16_t>(p.z * width_ + p.x);
  }

  // Writes the triangle (corner, `one`, `other`), which has a right angle at the corner. The sides
  // from the corner to `one` and to `other` are split into `stride` steps where requested.
  void half_cell(Place corner, Place one, bool divide_one, Place other, bool divide_other,
                 int stride) {
    const auto along = [&](Place end, int i) {
      return Place{corner.x + (end.x - corner.x) / stride * i,
                   corner.z + (end.z - corner.z) / stride * i};
    };
    const Place next = divide_other ? along(other, 1) : other;
    for (int i = 0; i < (divide_one ? stride : 1); ++i)
      triangle(divide_one ? along(one, i) : corner, divide_one ? along(one, i + 1) : one, next);
    for (int i = 1; divide_other && i < stride; ++i)
      triangle(along(other, i), one, along(other, i + 1));
  }

 private:
  int width_;
  std::span<std::uint16_t> out_;
  std::size_t at_ = 0;
};

}  // namespace

TerrainTiles::TerrainTiles(int size) : grid_(size, 0), stride_(TerrainGrid(size, 1).stride) {
  const int side = grid_.tiles_per_side();
  std::uint32_t first = 0, at = 0;
  for (std::uint32_t form = 0; form < kForms; ++form) {
    for (int tile = 0; tile < side * side; ++tile) {
      firsts_[at++] = first;
      first += index_count_of(rect_of(tile % side, tile / side), form);
    }
  }
  firsts_[at] = first;
}

TerrainTiles::Rect TerrainTiles::rect_of(int column, int row) const {
  return {grid_.tile_line(column), grid_.tile_line(row), grid_.tile_line(column + 1),
          grid_.tile_line(row + 1)};
}

std::uint32_t TerrainTiles::index_count_of(const Rect& rect, std::uint32_t form) const {
  const int wide = rect.x1 - rect.x0, deep = rect.z1 - rect.z0;
  if (form == 0) return static_cast<std::uint32_t>(6 * wide * deep);
  const int columns = wide / stride_, rows = deep / stride_;
  const std::uint32_t divided = form - 1;
  const int cells = columns * std::popcount(divided & (kNorth | kSouth)) +
                    rows * std::popcount(divided & (kEast | kWest));
  return static_cast<std::uint32_t>(3 * (2 * columns * rows + cells * (stride_ - 1)));
}

core::IndexPart TerrainTiles::part(std::uint32_t form, int column, int row) const {
  const int side = grid_.tiles_per_side();
  PSYGEN_ASSERT(column >= 0 && column < side && row >= 0 && row < side,
                "the block has such a tile");
  PSYGEN_ASSERT(form < kForms, "a tile has four sides");
  const std::uint32_t at = form * tiles() + static_cast<std::uint32_t>(row * side + column);
  return {firsts_[at], firsts_[at + 1] - firsts_[at]};
}

core::IndexPart TerrainTiles::skirt(int side) const {
  const core::IndexPart part = grid_.skirt(side);
  return {firsts_[kForms * tiles()] + part.first - 3 * grid_.surface_triangles(), part.count};
}

void TerrainTiles::write_indices(std::span<std::uint16_t> out) const {
  PSYGEN_CHECK(out.size() == index_count(), "the span has exactly the size of the list");
  std::vector<std::uint16_t> fine(std::size_t{grid_.triangles()} * 3);
  grid_.write_indices(fine);
  const auto surface = fine.begin() + 3 * grid_.surface_triangles();
  std::copy(fine.begin(), surface, out.begin());
  std::copy(surface, fine.end(), out.begin() + skirt(0).first);
  const int side = grid_.tiles_per_side();
  for (std::uint8_t divided = 0; divided <= kAll; ++divided) {
    for (int tile_at = 0; tile_at < side * side; ++tile_at) {
      const int column = tile_at % side, row = tile_at / side;
      const Rect r = rect_of(column, row);
      const core::IndexPart at = coarse(column, row, divided);
      Writer writer(grid_.size, out.subspan(at.first, at.count));
      const auto on = [divided](Sides side_of, bool border) {
        return border && (divided & side_of) != 0;
      };
      for (int z = r.z0; z < r.z1; z += stride_) {
        for (int x = r.x0; x < r.x1; x += stride_) {
          const Writer::Place near{x, z}, down{x, z + stride_}, right{x + stride_, z},
              far{x + stride_, z + stride_};
          writer.half_cell(near, down, on(kWest, x == r.x0), right, on(kNorth, z == r.z0), stride_);
          writer.half_cell(far, right, on(kEast, far.x == r.x1), down, on(kSouth, far.z == r.z1),
                           stride_);
        }
      }
    }
  }
}

}  // namespace psygen::models
