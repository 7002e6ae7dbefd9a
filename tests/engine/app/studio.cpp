#include "tests/engine/app/studio.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/draws/ground.hpp"
#include "engine/scene/state.hpp"

namespace psygen::app {
namespace {

// Tolerance of a node's ground, relative to the typical error of its level.
constexpr double kMinToleranceM = 0.5;

}  // namespace

image::Image Studio::drawn_again(const render::Light& light,
                                 std::span<const render::TerrainDraw> terrain,
                                 std::span<const render::MeshDraw> models) {
  const scene::State& s = state();
  render::FrameInput frame;
  frame.pose = s.camera.pose;
  frame.projection = s.camera.projection;
  frame.light = light;
  frame.palette = s.facts.palette;
  frame.canopy = s.facts.canopy;
  frame.morph = scene::morph_of(s.streaming);
  frame.block_size_m = s.facts.world.block_size_m();
  frame.terrain = terrain;
  frame.models = models;
  const auto drawn = session_->renderer().render(frame);
  EXPECT_TRUE(drawn) << drawn.error().message;
  auto picture = session_->renderer().capture();
  if (!picture) {
    ADD_FAILURE() << picture.error().message;
    return {};
  }
  return {picture->width, picture->height, std::move(picture->rgba)};
}

image::Image Studio::picture() {
  render::Light light = state().facts.light;
  light.time_seconds = 0;
  return drawn_again(light, state().draws.terrain, state().draws.models);
}

Studio::Lists Studio::lists() {
  const scene::State& s = state();
  return {s.camera.pose.position, s.draws.terrain, s.draws.models};
}

image::Image Studio::picture_of(Lists terrain_of, const Lists& models_of) {
  const scene::State& s = state();
  Lists lists{{}, std::move(terrain_of.terrain), models_of.models};
  const auto moved = [&](const core::WorldPosition& from) {
    const core::WorldPosition& eye = s.camera.pose.position;
    return glm::vec3(core::offset_m(from.block, eye, s.facts.world.block_size_m()) + from.local);
  };
  for (render::TerrainDraw& draw : lists.terrain)
    draw.origin += moved(terrain_of.eye);
  for (render::MeshDraw& draw : lists.models)
    draw.origin += moved(models_of.eye);
  render::Light light = s.facts.light;
  light.time_seconds = 0;
  return drawn_again(light, lists.terrain, lists.models);
}

image::Image Studio::ground_under(float haze_colour) {
  render::Light light = state().facts.light;
  light.haze_density = 0;
  light.cloud_cover = 0;
  light.haze_colour = glm::vec3(haze_colour);
  return drawn_again(light, state().draws.terrain, {});
}

std::size_t Studio::holes() {
  const std::vector<std::uint8_t> sky = this->sky();
  const std::size_t columns = width(), rows = height();
  std::size_t holes = 0;
  for (std::size_t x = 0; x < columns; ++x) {
    bool below = false;  // there is higher ground in this column
    for (std::size_t y = 0; y < rows; ++y) {
      if (sky[y * columns + x] == 0) {
        below = true;
        continue;
      }
      const glm::dvec3 direction = direction_of(static_cast<double>(x), static_cast<double>(y));
      // Checks only some pixels without ground above them, because each check is expensive.
      if ((below || (direction.y < 0 && (x + y) % 4 == 0)) && is_hole(direction)) ++holes;
    }
  }
  return holes;
}

bool Studio::is_hole(const glm::dvec3& direction) {
  const scene::State& s = state();
  const std::vector<scene::NodeLevel>& levels = s.facts.levels;
  const core::WorldPosition& eye = s.camera.pose.position;
  const double level_run = std::hypot(direction.x, direction.z);
  const double view_m = s.settings.view_distance_m;
  const auto height_at = [&](double run_m) {
    return eye.local.y + direction.y / level_run * run_m;
  };
  std::size_t level = 0;
  for (double run_m = 1; run_m < view_m; run_m += std::max(1.0, 0.004 * run_m)) {
    const double ray_m = height_at(run_m);
    while (level + 1 < levels.size() && s.streaming.distances[level + 1].split_m <= run_m)
      ++level;
    const double tolerance_m = kMinToleranceM + levels[level].ground_bound_m;
    if (ray_m > levels.back().bounds.max.y) {
      if (direction.y >= 0) return false;
      continue;
    }
    const core::WorldPosition at =
        core::normalised({eye.block,
                          {eye.local.x + direction.x / level_run * run_m, 0,
                           eye.local.z + direction.z / level_run * run_m}},
                         s.facts.world.block_size_m());
    if (!s.facts.world.contains(at.block)) continue;
    const double ground_m =
        models::ground_height_m(s.facts.world.terrain, at.block, at.local.x, at.local.z);
    if (ray_m < ground_m - tolerance_m) return true;
  }
  return false;
}

}  // namespace psygen::app
