#include "engine/scene/ground_draws.hpp"

#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/draw_parts.hpp"
#include "engine/scene/seen.hpp"

namespace psygen::scene {
namespace {

using Form = models::TerrainTiles::Form;

// Which tiles of a block are fine, with a rim of what is not: beyond the block lies another one's
// ground, with skirts in between.
class FineTiles {
 public:
  void set(int column, int row, bool fine) { fine_[place(column, row)] = fine; }
  Form form(int column, int row) const {
    const std::size_t at = place(column, row);
    if (fine_[at]) return Form::kFine;
    const bool beside_fine =
        fine_[at - 1] || fine_[at + 1] || fine_[at - kWide] || fine_[at + kWide];
    return beside_fine ? Form::kRimmed : Form::kCoarse;
  }

 private:
  static constexpr std::size_t kWide = models::kMostTilesPerSide + 2;
  static std::size_t place(int column, int row) {
    return static_cast<std::size_t>(row + 1) * kWide + static_cast<std::size_t>(column + 1);
  }
  std::array<bool, kWide * kWide> fine_{};
};

using Parts = DrawParts<render::TerrainDraw>;

// Seen from above.
float distance_m(const core::Bounds& box) {
  const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return glm::length(glm::vec2(nearest.x, nearest.z));
}

std::uint32_t bit(int tile) {
  return 1U << static_cast<unsigned>(tile);
}

// The skirts that show their outside: with them a gap beside a tile that is drawn is closed.
template <class Grid>
void add_skirts(const NodeTiles& tiles, std::uint32_t in_view, const Grid& grid, Parts& parts) {
  const int side = tiles.grid.tiles_per_side();
  const core::Bounds first = tiles.box(0, 0), last = tiles.box(side - 1, side - 1);
  struct Side {
    bool faces_camera;
    int tile, step;  // of the tiles along it: the first, from one to the next
  };
  const bool north = first.min.z > 0.0F, east = last.max.x < 0.0F;
  const bool south = last.max.z<0.0F, west = first.min.x> 0.0F;
  const std::array sides{Side{north, 0, 1}, Side{east, side - 1, side},
                         Side{south, side * (side - 1), 1}, Side{west, 0, side}};
  for (int i = 0; i < 4; ++i) {
    const Side& at = sides[static_cast<std::size_t>(i)];
    std::uint32_t along = 0;
    for (int k = 0; k < side; ++k)
      along |= bit(at.tile + k * at.step);
    if (in_view == kAllTiles || (at.faces_camera && (along & in_view) != 0))
      parts.add(grid.skirt(i));
  }
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
          corner + glm::vec3(line(column + 1), relief.top_m[tile], line(row + 1))};
}

std::uint32_t tiles_in_view(const NodeTiles& tiles, const View& view) {
  const int side = tiles.grid.tiles_per_side();
  std::uint32_t in_view = 0;
  for (int i = 0; i < side * side; ++i)
    in_view |= can_be_seen(tiles.box(i % side, i / side), view) ? bit(i) : 0;
  return in_view;
}

void add_tiles(const NodeTiles& tiles, std::uint32_t in_view, const models::TerrainTiles* fine,
               float fine_m, render::TerrainDraw draw, std::vector<render::TerrainDraw>& draws) {
  const int side = tiles.grid.tiles_per_side(), count = side * side;
  if (fine == nullptr) {
    Parts parts(draw, draws);
    for (int i = 0; i < count; ++i)
      if ((in_view & bit(i)) != 0) parts.add(tiles.grid.tile(i % side, i / side));
    return add_skirts(tiles, in_view, tiles.grid, parts);
  }
  draw.morph = render::kMorphByDistance;
  FineTiles near;
  for (int i = 0; i < count; ++i)
    near.set(i % side, i / side, distance_m(tiles.box(i % side, i / side)) < fine_m);
  Parts parts(draw, draws);
  for (const Form form : {Form::kFine, Form::kRimmed, Form::kCoarse}) {
    for (int i = 0; i < count; ++i) {
      const int column = i % side, row = i / side;
      if ((in_view & bit(i)) != 0 && near.form(column, row) == form)
        parts.add(fine->tile(column, row, form));
    }
  }
  add_skirts(tiles, in_view, *fine, parts);
}

}  // namespace psygen::scene
