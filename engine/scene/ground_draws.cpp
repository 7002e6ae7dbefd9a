#include "engine/scene/ground_draws.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace psygen::scene {
namespace {

using Form = models::TerrainTiles::Form;

// Draws vertices by their own distance (render::FrameInput::morph).
constexpr float kMorphByDistance = -1;

struct Tiling {
  const models::TerrainTiles& tiles;
  glm::vec3 corner;
  float cell_m, low_m, high_m, fine_m;

  core::Bounds box(int column, int row) const {
    const auto line = [this](int i) { return static_cast<float>(tiles.first_cell(i)) * cell_m; };
    return {corner + glm::vec3(line(column), low_m, line(row)),
            corner + glm::vec3(line(column + 1), high_m, line(row + 1))};
  }
  // False beyond the block: what lies there is another block's, with skirts in between.
  bool is_fine(int column, int row) const {
    if (std::min(column, row) < 0 || std::max(column, row) >= tiles.per_side()) return false;
    const core::Bounds at = box(column, row);
    const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), at.min, at.max);
    return glm::length(glm::vec2(nearest.x, nearest.z)) < fine_m;
  }
  Form form(int column, int row) const {
    if (is_fine(column, row)) return Form::kFine;
    const bool beside_fine = is_fine(column - 1, row) || is_fine(column + 1, row) ||
                             is_fine(column, row - 1) || is_fine(column, row + 1);
    return beside_fine ? Form::kRimmed : Form::kCoarse;
  }
};

}  // namespace

render::Morph morph_of(const Streaming& streaming) {
  const visibility::LevelDistances& blocks = streaming.distances[0];
  return {static_cast<float>(blocks.morph_m), static_cast<float>(blocks.split_m)};
}

void add_tiles(const models::TerrainTiles& tiles, const View& view, float low_m, float high_m,
               float fine_m, bool all, render::TerrainDraw draw,
               std::vector<render::TerrainDraw>& draws) {
  const Tiling tiling{tiles, draw.origin, draw.cell_m, low_m, high_m, fine_m};
  draw.morph = kMorphByDistance;
  for (int row = 0; row < tiles.per_side(); ++row) {
    for (int column = 0; column < tiles.per_side(); ++column) {
      const core::Bounds box = tiling.box(column, row);
      if (!all && (!visibility::intersects(view.frustum, box) || view.horizon.hides(box))) continue;
      draw.part = tiles.tile(column, row, tiling.form(column, row));
      draws.push_back(draw);
    }
  }
  draw.part = tiles.skirts();
  draws.push_back(draw);
}

}  // namespace psygen::scene
