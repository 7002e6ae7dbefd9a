#include "engine/models/terrain_tiles.hpp"

#include <algorithm>
#include <vector>

#include "engine/core/assert.hpp"

namespace psygen::models {

struct TerrainTiles::Rect {
  int x0, z0, x1, z1;
};

namespace {

// Writes triangles of vertices that are named by their place in the grid.
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

  // The triangle (corner, `one`, `other`) with a right angle at the corner; its sides from there
  // in steps of `stride` along `one` and `other` where they are to be divided.
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
  for (const Form form : {Form::kFine, Form::kRimmed, Form::kCoarse}) {
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

std::uint32_t TerrainTiles::index_count_of(const Rect& rect, Form form) const {
  const int wide = rect.x1 - rect.x0, deep = rect.z1 - rect.z0;
  if (form == Form::kFine) return static_cast<std::uint32_t>(6 * wide * deep);
  const int columns = wide / stride_, rows = deep / stride_;
  const int divided = form == Form::kRimmed ? 2 * (columns + rows) * (stride_ - 1) : 0;
  return static_cast<std::uint32_t>(3 * (2 * columns * rows + divided));
}

core::IndexPart TerrainTiles::tile(int column, int row, Form form) const {
  const int side = grid_.tiles_per_side();
  PSYGEN_ASSERT(column >= 0 && column < side && row >= 0 && row < side,
                "the block has such a tile");
  const std::uint32_t at =
      static_cast<std::uint32_t>(form) * tiles() + static_cast<std::uint32_t>(row * side + column);
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
  for (const Form form : {Form::kRimmed, Form::kCoarse}) {
    const bool rim = form == Form::kRimmed;
    for (int tile_at = 0; tile_at < side * side; ++tile_at) {
      const int column = tile_at % side, row = tile_at / side;
      const Rect r = rect_of(column, row);
      const core::IndexPart part = tile(column, row, form);
      Writer writer(grid_.size, out.subspan(part.first, part.count));
      for (int z = r.z0; z < r.z1; z += stride_) {
        for (int x = r.x0; x < r.x1; x += stride_) {
          const Writer::Place near{x, z}, down{x, z + stride_}, right{x + stride_, z},
              far{x + stride_, z + stride_};
          writer.half_cell(near, down, rim && x == r.x0, right, rim && z == r.z0, stride_);
          writer.half_cell(far, right, rim && far.x == r.x1, down, rim && far.z == r.z1, stride_);
        }
      }
    }
  }
}

}  // namespace psygen::models
