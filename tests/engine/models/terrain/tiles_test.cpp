#include "engine/models/terrain/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "engine/models/terrain/grid.hpp"

namespace psygen::models {
namespace {

using Triangle = std::array<std::uint16_t, 3>;

constexpr int kSizes[] = {4, 5, 8, 17, 33, 64, 65, 128};
constexpr int kFine = -1;  // else the sides of a coarse tile that are divided

// Rotates the smallest index to the front, in the same direction.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<Triangle> triangles_of(std::span<const std::uint16_t> indices) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    triangles.push_back(canonical({indices[i], indices[i + 1], indices[i + 2]}));
  return triangles;
}

std::vector<std::uint16_t> list_of(const TerrainTiles& tiles) {
  std::vector<std::uint16_t> list(tiles.index_count());
  tiles.write_indices(list);
  return list;
}

std::vector<Triangle> tile_of(const TerrainTiles& tiles, int column, int row, int form) {
  const std::vector<std::uint16_t> list = list_of(tiles);
  const core::IndexPart part = form == kFine
                                   ? tiles.fine(column, row)
                                   : tiles.coarse(column, row, static_cast<std::uint8_t>(form));
  return triangles_of(std::span(list).subspan(part.first, part.count));
}

std::set<Triangle> all_of(const TerrainTiles& tiles, int form) {
  std::set<Triangle> all;
  for (int row = 0; row < tiles.grid().tiles_per_side(); ++row) {
    for (int column = 0; column < tiles.grid().tiles_per_side(); ++column) {
      for (const Triangle& t : tile_of(tiles, column, row, form))
        EXPECT_TRUE(all.insert(t).second) << "a triangle is in two tiles";
    }
  }
  return all;
}

std::set<Triangle> surface_of(int size, int level) {
  const TerrainGrid grid(size, level);
  std::vector<std::uint16_t> indices(std::size_t{grid.triangles()} * 3);
  grid.write_indices(indices);
  indices.resize(std::size_t{grid.surface_triangles()} * 3);
  const auto at_level_0 = [&](std::uint16_t v) {
    return static_cast<std::uint16_t>(v / grid.n * grid.stride * size + v % grid.n * grid.stride);
  };
  std::transform(indices.begin(), indices.end(), indices.begin(), at_level_0);
  const std::vector<Triangle> triangles = triangles_of(indices);
  return {triangles.begin(), triangles.end()};
}

// Twice the area seen from above, positive for the direction that the engine draws.
int doubled_area(const Triangle& t, int size) {
  const auto x = [size](std::uint16_t v) { return v % size; };
  const auto z = [size](std::uint16_t v) { return v / size; };
  return (z(t[1]) - z(t[0])) * (x(t[2]) - x(t[0])) - (x(t[1]) - x(t[0])) * (z(t[2]) - z(t[0]));
}

TEST(TerrainGrid, TilesOfEveryLevelAreTheCellsBetweenTheirLines) {
  for (const int size : kSizes) {
    for (int level = 0; level < kTerrainLevels; ++level) {
      const TerrainGrid grid(size, level);
      std::vector<std::uint16_t> list(std::size_t{grid.triangles()} * 3);
      grid.write_indices(list);
      const int side = grid.tiles_per_side();
      EXPECT_EQ(grid.tile_line(0), 0);
      EXPECT_EQ(grid.tile_line(side), grid.n - 1);
      for (int tile = 0; tile < side * side; ++tile) {
        const int column = tile % side, row = tile / side;
        const core::IndexPart part = grid.tile(column, row);
        const int cells = (grid.tile_line(column + 1) - grid.tile_line(column)) *
                          (grid.tile_line(row + 1) - grid.tile_line(row));
        EXPECT_EQ(part.count, static_cast<std::uint32_t>(6 * cells));
        for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
          EXPECT_GE(list[i] % grid.n, grid.tile_line(column));
          EXPECT_LE(list[i] % grid.n, grid.tile_line(column + 1));
          EXPECT_GE(list[i] / grid.n, grid.tile_line(row));
          EXPECT_LE(list[i] / grid.n, grid.tile_line(row + 1));
        }
      }
    }
  }
}

TEST(TerrainTiles, FormTheSurfacesOfTheirTwoLevels) {
  for (const int size : kSizes) {
    const TerrainTiles tiles(size);
    EXPECT_EQ(all_of(tiles, kFine), surface_of(size, 0)) << size;
    EXPECT_EQ(all_of(tiles, TerrainTiles::kNone), surface_of(size, 1)) << size;
  }
}

TEST(TerrainTiles, CoverEveryTileOnceInEveryForm) {
  for (const int size : kSizes) {
    const TerrainTiles tiles(size);
    EXPECT_EQ(tiles.grid().tile_line(0), 0);
    EXPECT_EQ(tiles.grid().tile_line(tiles.grid().tiles_per_side()), size - 1);
    for (int form = kFine; form <= TerrainTiles::kAll; ++form) {
      for (int row = 0; row < tiles.grid().tiles_per_side(); ++row) {
        for (int column = 0; column < tiles.grid().tiles_per_side(); ++column) {
          int area = 0;
          for (const Triangle& t : tile_of(tiles, column, row, form)) {
            EXPECT_GT(doubled_area(t, size), 0) << size;
            area += doubled_area(t, size);
          }
          const int wide = tiles.grid().tile_line(column + 1) - tiles.grid().tile_line(column);
          const int deep = tiles.grid().tile_line(row + 1) - tiles.grid().tile_line(row);
          EXPECT_GT(wide * deep, 0);
          EXPECT_EQ(area, 2 * wide * deep) << size;
        }
      }
    }
  }
}

// Sides that only one triangle of a tile has, which form its border.
std::set<std::pair<std::uint16_t, std::uint16_t>> border_of(const std::vector<Triangle>& tile) {
  std::set<std::pair<std::uint16_t, std::uint16_t>> sides;
  for (const Triangle& t : tile) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair side{t[k], t[(k + 1) % 3]};
      if (sides.erase({side.second, side.first}) == 0) sides.insert(side);
    }
  }
  return sides;
}

// Any tiles fine: every side of a triangle is one of its neighbour's as well, with no vertex on it,
// or is on the border of the block.
TEST(TerrainTiles, MeetWithoutAVertexOnASideInEveryCombination) {
  for (const int size : kSizes) {
    const TerrainTiles tiles(size);
    const int side = tiles.grid().tiles_per_side(), count = side * side;
    for (int fine = 0; fine < 1 << count; fine += size == 64 ? 1 : 7) {
      const auto is_fine = [&](int column, int row) {
        return column >= 0 && column < side && row >= 0 && row < side &&
               (fine >> (row * side + column) & 1) != 0;
      };
      std::vector<Triangle> ground;
      for (int tile = 0; tile < count; ++tile) {
        const int column = tile % side, row = tile / side;
        const int divided = (is_fine(column, row - 1) ? TerrainTiles::kNorth : 0) |
                            (is_fine(column + 1, row) ? TerrainTiles::kEast : 0) |
                            (is_fine(column, row + 1) ? TerrainTiles::kSouth : 0) |
                            (is_fine(column - 1, row) ? TerrainTiles::kWest : 0);
        const auto part = tile_of(tiles, column, row, is_fine(column, row) ? kFine : divided);
        ground.insert(ground.end(), part.begin(), part.end());
      }
      for (const auto& [from, to] : border_of(ground)) {
        const auto along = [&](int a, int b) { return a == b && (a == 0 || a == size - 1); };
        ASSERT_TRUE(along(from % size, to % size) || along(from / size, to / size))
            << "size " << size << ", fine tiles " << fine;
      }
    }
  }
}

TEST(TerrainTiles, HaveTheSkirtsOfTheWholeMeshAtTheEnd) {
  for (const int size : kSizes) {
    const TerrainTiles tiles(size);
    const TerrainGrid& grid = tiles.grid();
    std::vector<std::uint16_t> whole(std::size_t{grid.triangles()} * 3);
    grid.write_indices(whole);
    const std::vector<std::uint16_t> list = list_of(tiles);
    for (int side = 0; side < 4; ++side) {
      const core::IndexPart part = tiles.skirt(side), same = grid.skirt(side);
      ASSERT_EQ(part.count, same.count);
      EXPECT_TRUE(std::equal(list.begin() + part.first, list.begin() + part.first + part.count,
                             whole.begin() + same.first));
    }
    EXPECT_EQ(tiles.skirt(3).first + tiles.skirt(3).count, list.size());
  }
}

TEST(TerrainTiles, OfThePaperAreThreeASide) {
  const TerrainTiles tiles(64);
  EXPECT_EQ(tiles.grid().tiles_per_side(), 3);
  EXPECT_EQ(tiles.fine(1, 1).count, 882U * 3);
  EXPECT_EQ(tiles.coarse(1, 1, TerrainTiles::kAll).count, 154U * 3);
  EXPECT_EQ(tiles.coarse(1, 1, TerrainTiles::kNone).count, 98U * 3);
}

}  // namespace
}  // namespace psygen::models
