// Prioritized-Layered Projection over the blocks of the window (paper, section 4) from where the
// camera is. Blocks that the camera would see from where it is predicted to be get the time until
// then as their deadline. Models inherit their block's key.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "engine/scene/missing.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

core::Bounds block_bounds(const WorldFacts& facts, const core::Bounds& terrain,
                          const core::WorldPosition& camera, core::BlockCoord coord) {
  const glm::vec3 corner(core::offset_m(coord, camera, facts.world.block_size_m()));
  core::Bounds box{corner + terrain.min, corner + terrain.max};
  box.max.y += facts.models_reach_m.y;
  // Crowns reach over the block's edge.
  const glm::vec3 overhang(facts.models_reach_m.x, 0.0F, facts.models_reach_m.x);
  return {box.min - overhang, box.max + overhang};
}

float distance_to(const core::Bounds& box) {
  const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return glm::length(nearest);
}

visibility::PlpInput plp_input(const BlockGrid& grid, const std::vector<core::Bounds>& bounds,
                               const visibility::Frustum& frustum) {
  return {grid.side(),
          grid.side(),
          grid.radius(),
          grid.radius(),
          bounds,
          &frustum,
          grid.side() * grid.side()};
}

visibility::Frustum frustum_of(const core::CameraPose& pose, const core::Projection& projection) {
  return visibility::make_frustum(core::projection_matrix(projection) * core::view_rotation(pose));
}

// Lowers the deadline of every cell that the predicted camera sees.
void expect(const Camera& camera, const Camera::Prediction& prediction, double block_size_m,
            std::span<const core::Bounds> bounds, std::span<float> deadlines) {
  const core::WorldPosition& to = prediction.pose.position;
  const glm::vec3 moved(core::offset_m(to.block, camera.pose.position, block_size_m) + to.local);
  const visibility::Frustum frustum = frustum_of(prediction.pose, camera.projection);
  for (std::size_t cell = 0; cell < bounds.size(); ++cell) {
    if (deadlines[cell] <= prediction.tau_s) continue;
    if (visibility::intersects(frustum, {bounds[cell].min - moved, bounds[cell].max - moved})) {
      deadlines[cell] = prediction.tau_s;
    }
  }
}

void write_visibility(const View& view, const BlockGrid& grid, float view_distance_m,
                      const VisibilityQuery& query) {
  query.each([&](std::span<const ecs::Entity>, std::span<const Block> blocks,
                 std::span<Visibility> visibilities) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::size_t cell = grid.window_index(blocks[i].coord);
      Visibility& visibility = visibilities[i];
      visibility.distance_m = distance_to(view.bounds[cell]);
      visibility.layer = view.plp.layer[cell];
      visibility.in_view =
          view.plp.in_view[cell] != 0 && visibility.distance_m <= view_distance_m ? 1 : 0;
      visibility.deadline_s = visibility.in_view != 0 ? 0.0F : view.deadlines[cell];
    }
  });
}

// A block in view that has no entity yet is a hole like any other.
void count_missing_block(const Camera& camera, const core::Bounds& box, Counters& counters) {
  ++counters.nodes_in_view;
  ++counters.holes;
  counters.missing_pixels_percent +=
      covered_percent(camera, box.center(), glm::length(box.half_extent()));
}

// Sorts the window's blocks into the three lists of the view, each in order of importance.
void list_blocks(const Camera& camera, const WorldFacts& facts, const BlockGrid& grid,
                 float view_distance_m, const VisibilityQuery& query, View& view,
                 Counters& counters) {
  view.visible.clear();
  view.expected.clear();
  view.around.clear();
  const auto coord_of = [&grid](std::uint32_t cell) {
    return grid.coord_at(cell % grid.side(), cell / grid.side());
  };
  struct Expected {
    float deadline_s;
    ecs::Entity block;
  };
  std::vector<Expected> expected;
  const auto keep_out_of_view = [&](std::uint32_t cell, ecs::Entity entity) {
    if (std::isfinite(view.deadlines[cell])) {
      expected.push_back({view.deadlines[cell], entity});
    } else {
      view.around.push_back(entity);
    }
  };
  for (const std::uint32_t cell : view.plp.visible) {
    const core::BlockCoord coord = coord_of(cell);
    const ecs::Entity entity = grid.entity_of(coord);
    const bool near = distance_to(view.bounds[cell]) <= view_distance_m;
    if (query.alive(entity)) {
      // Straight ahead, but beyond the view distance: the next to come.
      near ? view.visible.push_back(entity) : keep_out_of_view(cell, entity);
    } else if (near && facts.world.contains(coord)) {
      count_missing_block(camera, view.bounds[cell], counters);
    }
  }
  for (const std::uint32_t cell : view.plp.prefetch) {
    const ecs::Entity entity = grid.entity_of(coord_of(cell));
    if (query.alive(entity)) keep_out_of_view(cell, entity);
  }
  std::ranges::stable_sort(expected, {}, &Expected::deadline_s);
  for (const Expected& soon : expected)
    view.expected.push_back(soon.block);
}

}  // namespace

void visibility_system(const Settings& settings, const Camera& camera, const WorldFacts& facts,
                       const Streaming& streaming, VisibilityQuery blocks, View& view,
                       Counters& counters) {
  const BlockGrid& grid = streaming.grid;
  const core::Bounds terrain =
      facts.registry[facts.world.terrain_model].bounds(facts.world.terrain);
  view.bounds.clear();
  for (std::uint32_t row = 0; row < grid.side(); ++row) {
    for (std::uint32_t column = 0; column < grid.side(); ++column) {
      view.bounds.push_back(
          block_bounds(facts, terrain, camera.pose.position, grid.coord_at(column, row)));
    }
  }
  view.frustum = frustum_of(camera.pose, camera.projection);
  visibility::run_plp(plp_input(grid, view.bounds, view.frustum), view.plp);

  view.deadlines.assign(view.bounds.size(), std::numeric_limits<float>::infinity());
  for (const Camera::Prediction& prediction : camera.predictions) {
    expect(camera, prediction, facts.world.block_size_m(), view.bounds, view.deadlines);
  }
  const auto view_distance_m = static_cast<float>(settings.view_distance_m);
  write_visibility(view, grid, view_distance_m, blocks);
  list_blocks(camera, facts, grid, view_distance_m, blocks, view, counters);
}

}  // namespace psygen::scene
