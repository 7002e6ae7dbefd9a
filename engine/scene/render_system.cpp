// Turns what is in view and resident into draw lists, nearest blocks first, counts what is missing,
// and hands the lists to the renderer.
#include <algorithm>

#include "engine/scene/lighting.hpp"
#include "engine/scene/missing.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// How far a block's border hangs down, in metres per metre of its coarsest error, at least one.
constexpr float kSkirtPerError = 2.0F;

// Counts a node in view; true if it can be drawn.
bool count_node(const Camera& camera, const Demand& demand, glm::vec3 center, float radius_m,
                Counters& counters) {
  ++counters.nodes_in_view;
  const bool hole = demand.drawn_level == kNoLevel;
  const bool coarse = !hole && demand.drawn_level > demand.wanted_level + 1;
  if (hole) ++counters.holes;
  if (coarse) ++counters.coarse;
  if (hole || coarse) {
    counters.missing_pixels_percent += covered_percent(camera, center, radius_m);
  }
  return !hole;
}

void add_terrain(const WorldFacts& facts, const Mesh& mesh, const Placed& placed,
                 const Detail& detail, glm::vec3 corner, DrawLists& draws) {
  render::TerrainDraw draw;
  draw.range = mesh.range;
  draw.shared_indices = mesh.shared_indices;
  draw.origin = corner;
  draw.cell_m = facts.cell_m;
  draw.height_min_m = placed.box_center.y - placed.box_half_extent.y;
  draw.height_range_m = 2 * placed.box_half_extent.y;
  draw.skirt_m = 1.0F + kSkirtPerError * detail.error_m[detail.level_count - 1];
  draws.terrain.push_back(draw);
}

void add_models(const Camera& camera, const RenderQuery& entities, const ecs::Children& models,
                glm::vec3 corner, std::uint32_t tick, DrawLists& draws, Counters& counters) {
  entities.each_of<const Placed, const Demand, const Mesh>(
      entities.children(models),
      [&](std::span<const ecs::Entity>, std::span<const Placed> placed,
          std::span<const Demand> demands, std::span<const Mesh> meshes) {
        for (std::size_t i = 0; i < placed.size(); ++i) {
          const Demand& demand = demands[i];
          if (demand.wanted_level == kNoLevel || demand.in_view_tick != tick) continue;
          const glm::vec3 foot = corner + placed[i].position;
          if (!count_node(camera, demand, foot + placed[i].box_center, placed[i].radius_m,
                          counters)) {
            continue;
          }
          draws.models.push_back({meshes[i].range, meshes[i].shared_indices, foot,
                                  placed[i].box_center, placed[i].box_half_extent, 1.0F});
        }
      });
}

}  // namespace

void render_system(const Input& input, const Clock& clock, const Camera& camera,
                   const WorldFacts& facts, const View& view, RenderQuery entities,
                   DrawLists& draws, Output& output, Counters& counters) {
  draws.terrain.clear();
  draws.models.clear();
  entities.each_of(
      view.visible, [&](std::span<const ecs::Entity>, std::span<const Block> blocks,
                        std::span<const ecs::Children> models, std::span<const Placed> placed,
                        std::span<const Detail> details, std::span<const Demand> demands,
                        std::span<const Mesh> meshes) {
        for (std::size_t i = 0; i < blocks.size(); ++i) {
          const glm::vec3 corner(
              core::offset_m(blocks[i].coord, camera.pose.position, facts.world.block_size_m()));
          if (count_node(camera, demands[i], corner + placed[i].box_center, placed[i].radius_m,
                         counters)) {
            add_terrain(facts, meshes[i], placed[i], details[i], corner, draws);
          }
          add_models(camera, entities, models[i], corner, clock.tick, draws, counters);
        }
      });
  counters.missing_pixels_percent = std::min(counters.missing_pixels_percent, 100.0);
  if (output.renderer == nullptr) return;

  render::FrameInput frame;
  frame.pose = camera.pose;
  frame.projection = camera.projection;
  frame.light = facts.light;
  if (facts.world.sky.day_length_s > 0) move_sun(facts.world, clock.now_s, frame.light);
  frame.light.time_seconds = static_cast<float>(clock.now_s);
  frame.palette = facts.palette;
  frame.water = water_of(facts.world);
  frame.view = input.view;
  frame.block_size_m = facts.world.block_size_m();
  frame.terrain = draws.terrain;
  frame.models = draws.models;
  frame.overlay_lines = input.overlay_lines;
  const auto result = output.renderer->render(frame);
  if (result) {
    counters.frame = *result;
  } else {
    output.error = result.error();
  }
}

}  // namespace psygen::scene
