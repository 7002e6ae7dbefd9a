// Turns what is in view and resident into draw lists, nearest blocks first, counts what is missing,
// and hands the lists to the renderer.
#include <algorithm>

#include "engine/scene/missing.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// How far a block's border hangs down, in metres per metre of its coarsest error, at least one.
constexpr float kSkirtPerError = 2.0F;

struct Columns {
  ecs::Accessor<const Placed> placed;
  ecs::Accessor<const Demand> demand;
  ecs::Accessor<const Mesh> mesh;
  ecs::Accessor<const Detail> detail;
};

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

void add_block(const Camera& camera, const WorldFacts& facts, const Streaming& streaming,
               const Columns& columns, const Block& block, ecs::Entity entity, std::uint32_t tick,
               DrawLists& draws, Counters& counters) {
  const glm::vec3 corner(
      core::offset_m(block.coord, camera.pose.position, facts.world.block_size_m()));
  const Placed& ground = *columns.placed.get(entity);
  if (count_node(camera, *columns.demand.get(entity), corner + ground.box_center, ground.radius_m,
                 counters)) {
    add_terrain(facts, *columns.mesh.get(entity), ground, *columns.detail.get(entity), corner,
                draws);
  }
  for (const ecs::Entity model : streaming.models.of(block.slab).first(block.model_count)) {
    const Demand& demand = *columns.demand.get(model);
    if (demand.wanted_level == kNoLevel || demand.in_view_tick != tick) continue;
    const Placed& placed = *columns.placed.get(model);
    const glm::vec3 foot = corner + placed.position;
    if (!count_node(camera, demand, foot + placed.box_center, placed.radius_m, counters)) continue;
    const Mesh& mesh = *columns.mesh.get(model);
    draws.models.push_back(
        {mesh.range, mesh.shared_indices, foot, placed.box_center, placed.box_half_extent, 1.0F});
  }
}

}  // namespace

void render_system(const Input& input, const Clock& clock, const Camera& camera,
                   const WorldFacts& facts, const Streaming& streaming, const View& view,
                   ecs::World& entities, DrawLists& draws, render::Renderer* renderer,
                   Counters& counters, std::optional<core::Error>& error) {
  draws.terrain.clear();
  draws.models.clear();
  const Columns columns{entities.accessor<const Placed>(), entities.accessor<const Demand>(),
                        entities.accessor<const Mesh>(), entities.accessor<const Detail>()};
  for (const ecs::Entity entity : view.visible) {
    add_block(camera, facts, streaming, columns, *entities.get<Block>(entity), entity, clock.tick,
              draws, counters);
  }
  counters.missing_pixels_percent = std::min(counters.missing_pixels_percent, 100.0);
  if (renderer == nullptr) return;

  render::FrameInput frame;
  frame.pose = camera.pose;
  frame.projection = camera.projection;
  frame.light = facts.light;
  frame.light.time_seconds = static_cast<float>(clock.now_s);
  frame.palette = facts.palette;
  frame.block_size_m = facts.world.block_size_m();
  frame.terrain = draws.terrain;
  frame.models = draws.models;
  frame.overlay_lines = input.overlay_lines;
  const auto result = renderer->render(frame);
  if (result) {
    counters.frame = *result;
  } else {
    error = result.error();
  }
}

}  // namespace psygen::scene
