#include "engine/scene/draws/ground.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/draws/models.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

using models::TerrainTiles;

// The fine tiles of a block. All skirts are fine: they have every vertex of the border.
class FineTiles {
 public:
  // `skirts`: the sides (TerrainTiles::Sides) with skirts.
  FineTiles(int side, std::uint8_t skirts) {
    for (int i = 0; i < side; ++i) {
      set(i, -1, (skirts & TerrainTiles::kNorth) != 0);
      set(side, i, (skirts & TerrainTiles::kEast) != 0);
      set(i, side, (skirts & TerrainTiles::kSouth) != 0);
      set(-1, i, (skirts & TerrainTiles::kWest) != 0);
    }
  }
  void set(int column, int row, bool fine) { fine_[place(column, row)] = fine; }
  bool fine(int column, int row) const { return fine_[place(column, row)]; }
  // The sides on which a tile borders fine tiles or skirts.
  std::uint8_t fine_sides(int column, int row) const {
    const std::size_t at = place(column, row);
    return static_cast<std::uint8_t>(
        (fine_[at - kWide] ? TerrainTiles::kNorth : 0) | (fine_[at + 1] ? TerrainTiles::kEast : 0) |
        (fine_[at + kWide] ? TerrainTiles::kSouth : 0) | (fine_[at - 1] ? TerrainTiles::kWest : 0));
  }

 private:
  static constexpr std::size_t kWide = models::kMaxTilesPerSide + 2;
  static std::size_t place(int column, int row) {
    return static_cast<std::size_t>(row + 1) * kWide + static_cast<std::size_t>(column + 1);
  }
  std::array<bool, kWide * kWide> fine_{};
};

using Parts = DrawParts<render::TerrainDraw>;

// Distance in the horizontal plane.
float distance_m(const core::Bounds& box) {
  const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return glm::length(glm::vec2(nearest.x, nearest.z));
}

bool is_near(const core::Bounds& box) {
  return glm::length(glm::clamp(glm::vec3(0.0F), box.min, box.max)) < render::kNearGroundM;
}

std::uint32_t bit(int tile) {
  return 1U << static_cast<unsigned>(tile);
}

// The sides (TerrainTiles::Sides) with visible skirts: those that show their outside and close gaps
// beside drawn tiles; all of them if all tiles are drawn.
std::uint8_t sides_with_skirts(const NodeTiles& tiles, std::uint32_t in_view) {
  if (in_view == kAllTiles) return TerrainTiles::kAll;
  const int side = tiles.grid.tiles_per_side();
  const core::Bounds first = tiles.box(0, 0), last = tiles.box(side - 1, side - 1);
  struct Side {
    bool faces_camera;
    int tile, step;  // of the tiles along the side: the first one, and the step to the next
  };
  const bool north = first.min.z > 0.0F, east = last.max.x < 0.0F;
  const bool south = last.max.z<0.0F, west = first.min.x> 0.0F;
  const std::array sides{Side{north, 0, 1}, Side{east, side - 1, side},
                         Side{south, side * (side - 1), 1}, Side{west, 0, side}};
  std::uint8_t with_skirts = 0;
  for (unsigned i = 0; i < 4; ++i) {
    std::uint32_t along = 0;
    for (int k = 0; k < side; ++k)
      along |= bit(sides[i].tile + k * sides[i].step);
    if (sides[i].faces_camera && (along & in_view) != 0)
      with_skirts = static_cast<std::uint8_t>(with_skirts | 1U << i);
  }
  return with_skirts;
}

template <class Grid>
void add_skirts(const Grid& grid, std::uint8_t sides, Parts& parts) {
  parts.set(&render::TerrainDraw::near, false);
  for (int i = 0; i < 4; ++i)
    if ((sides >> i & 1) != 0) parts.add(grid.skirt(i));
}

}  // namespace

render::Morph morph_of(const Streaming& streaming) {
  const visibility::LevelDistances& fine = streaming.distances[0];
  return {static_cast<float>(fine.morph_m), static_cast<float>(fine.split_m)};
}

core::Bounds NodeTiles::box(int column, int row) const {
  const float step_m = cell_m * static_cast<float>(grid.stride);
  const auto line = [&](int i) { return static_cast<float>(grid.tile_line(i)) * step_m; };
  const auto tile = static_cast<std::size_t>(row * grid.tiles_per_side() + column);
  return {corner + glm::vec3(line(column), low_m, line(row)),
          corner + glm::vec3(line(column + 1), occluder.top_m[tile], line(row + 1))};
}

std::uint32_t tiles_in_view(const NodeTiles& tiles, const View& view) {
  const int side = tiles.grid.tiles_per_side();
  std::uint32_t in_view = 0;
  for (int i = 0; i < side * side; ++i)
    in_view |= may_be_visible(tiles.box(i % side, i / side), view) ? bit(i) : 0;
  return in_view;
}

void add_tiles(const NodeTiles& tiles, std::uint32_t in_view, const models::TerrainTiles* fine,
               float fine_m, render::TerrainDraw draw, std::vector<render::TerrainDraw>& draws) {
  const int side = tiles.grid.tiles_per_side(), count = side * side;
  const std::uint8_t skirts = sides_with_skirts(tiles, in_view);
  if (fine == nullptr) {
    Parts parts(draw, draws);
    for (int i = 0; i < count; ++i) {
      if ((in_view & bit(i)) == 0) continue;
      parts.set(&render::TerrainDraw::near, is_near(tiles.box(i % side, i / side)));
      parts.add(tiles.grid.tile(i % side, i / side));
    }
    return add_skirts(tiles.grid, skirts, parts);
  }
  draw.morph = render::kMorphByDistance;
  FineTiles near(side, skirts);
  for (int i = 0; i < count; ++i)
    near.set(i % side, i / side, distance_m(tiles.box(i % side, i / side)) < fine_m);
  struct Chosen {
    core::IndexPart part;
    bool near = false;
  };
  std::array<Chosen, models::kMaxTilesPerSide * models::kMaxTilesPerSide> chosen;
  auto end = chosen.begin();  // in the order of their indices
  for (int i = 0; i < count; ++i) {
    const int column = i % side, row = i / side;
    if ((in_view & bit(i)) == 0) continue;
    const Chosen tile{near.fine(column, row)
                          ? fine->fine(column, row)
                          : fine->coarse(column, row, near.fine_sides(column, row)),
                      is_near(tiles.box(column, row))};
    const auto at = std::upper_bound(
        chosen.begin(), end, tile,
        [](const Chosen& a, const Chosen& b) { return a.part.first < b.part.first; });
    std::move_backward(at, end, end + 1);
    *at = tile;
    ++end;
  }
  Parts parts(draw, draws);
  for (auto tile = chosen.begin(); tile != end; ++tile) {
    parts.set(&render::TerrainDraw::near, tile->near);
    parts.add(tile->part);
  }
  add_skirts(*fine, skirts, parts);
}

}  // namespace psygen::scene
