#include "engine/models/terrain_tiles.hpp"

#include <algorithm>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/models/terrain_grid.hpp"

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

TerrainTiles::TerrainTiles(int size)
    : size_(size),
      stride_(TerrainGrid(size, 1).stride),
      per_side_(std::min((size - 1) / stride_, kMostPerSide)),
      skirt_indices_(TerrainGrid(size, 0).border_vertices() * 6) {
  const int coarse = (size_ - 1) / stride_;
  for (int i = 0; i <= per_side_; ++i)
    first_cell_[static_cast<std::size_t>(i)] = coarse * i / per_side_ * stride_;
  std::uint32_t first = 0, at = 0;
  for (const Form form : {Form::kFine, Form::kRimmed, Form::kCoarse}) {
    for (int row = 0; row < per_side_; ++row) {
      for (int column = 0; column < per_side_; ++column) {
        firsts_[at++] = first;
        first += index_count_of(rect_of(column, row), form);
      }
    }
  }
  firsts_[at] = first;
}

TerrainTiles::Rect TerrainTiles::rect_of(int column, int row) const {
  return {first_cell(column), first_cell(row), first_cell(column + 1), first_cell(row + 1)};
}

std::uint32_t TerrainTiles::index_count_of(const Rect& rect, Form form) const {
  const int wide = rect.x1 - rect.x0, deep = rect.z1 - rect.z0;
  if (form == Form::kFine) return static_cast<std::uint32_t>(6 * wide * deep);
  const int columns = wide / stride_, rows = deep / stride_;
  const int divided = form == Form::kRimmed ? 2 * (columns + rows) * (stride_ - 1) : 0;
  return static_cast<std::uint32_t>(3 * (2 * columns * rows + divided));
}

core::IndexPart TerrainTiles::tile(int column, int row, Form form) const {
  PSYGEN_ASSERT(column >= 0 && column < per_side_ && row >= 0 && row < per_side_,
                "the block has such a tile");
  const std::uint32_t at = static_cast<std::uint32_t>(form) * tiles() +
                           static_cast<std::uint32_t>(row * per_side_ + column);
  return {tile_first(at), tile_first(at + 1) - tile_first(at)};
}

void TerrainTiles::write_indices(std::span<std::uint16_t> out) const {
  PSYGEN_CHECK(out.size() == index_count(), "the span has exactly the size of the list");
  for (const Form form : {Form::kFine, Form::kRimmed, Form::kCoarse}) {
    const int step = form == Form::kFine ? 1 : stride_;
    const bool rim = form == Form::kRimmed;
    for (int row = 0; row < per_side_; ++row) {
      for (int column = 0; column < per_side_; ++column) {
        const Rect r = rect_of(column, row);
        const core::IndexPart part = tile(column, row, form);
        Writer writer(size_, out.subspan(part.first, part.count));
        for (int z = r.z0; z < r.z1; z += step) {
          for (int x = r.x0; x < r.x1; x += step) {
            const Writer::Place near{x, z}, down{x, z + step}, right{x + step, z},
                far{x + step, z + step};
            writer.half_cell(near, down, rim && x == r.x0, right, rim && z == r.z0, step);
            writer.half_cell(far, right, rim && far.x == r.x1, down, rim && far.z == r.z1, step);
          }
        }
      }
    }
  }
  const TerrainGrid grid(size_, 0);
  std::vector<std::uint16_t> whole(std::size_t{grid.triangles()} * 3);
  grid.write_indices(whole);
  std::copy_n(whole.end() - skirt_indices_, skirt_indices_, out.begin() + skirts().first);
}

}  // namespace psygen::models
