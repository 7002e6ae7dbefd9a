#include "engine/scene/ground_draws.hpp"

#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

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
  static constexpr std::size_t kWide = models::TerrainTiles::kMostPerSide + 2;
  static std::size_t place(int column, int row) {
    return static_cast<std::size_t>(row + 1) * kWide + static_cast<std::size_t>(column + 1);
  }
  std::array<bool, kWide * kWide> fine_{};
};

// Seen from above.
float distance_m(const core::Bounds& box) {
  const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return glm::length(glm::vec2(nearest.x, nearest.z));
}

}  // namespace

render::Morph morph_of(const Streaming& streaming) {
  const visibility::LevelDistances& blocks = streaming.distances[0];
  return {static_cast<float>(blocks.morph_m), static_cast<float>(blocks.split_m)};
}

void add_tiles(const models::TerrainTiles& tiles, const View& view, float low_m, float high_m,
               float fine_m, bool all, render::TerrainDraw draw,
               std::vector<render::TerrainDraw>& draws) {
  draw.morph = render::kMorphByDistance;
  const int side = tiles.per_side();
  const auto box_of = [&](int column, int row) {
    const auto line = [&](int i) { return static_cast<float>(tiles.first_cell(i)) * draw.cell_m; };
    return core::Bounds{draw.origin + glm::vec3(line(column), low_m, line(row)),
                        draw.origin + glm::vec3(line(column + 1), high_m, line(row + 1))};
  };
  FineTiles fine;
  for (int i = 0; i < side * side; ++i)
    fine.set(i % side, i / side, distance_m(box_of(i % side, i / side)) < fine_m);
  for (int i = 0; i < side * side; ++i) {
    const core::Bounds box = box_of(i % side, i / side);
    if (!all && (!visibility::intersects(view.frustum, box) || view.horizon.hides(box))) continue;
    draw.part = tiles.tile(i % side, i / side, fine.form(i % side, i / side));
    draws.push_back(draw);
  }
  draw.part = tiles.skirts();
  draws.push_back(draw);
}

}  // namespace psygen::scene
