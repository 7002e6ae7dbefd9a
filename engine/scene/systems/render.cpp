// Turns what is in view and resident into draw lists, nearest nodes first, counts what is missing,
// and hands the lists to the renderer. Where nodes of the cut are not ready an ancestor is drawn
// until all that replaces it is; where nothing is complete, the finest ground that closes the gap.
#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

#include "engine/render/particles.hpp"
#include "engine/scene/draws/ground.hpp"
#include "engine/scene/draws/ground_spots.hpp"
#include "engine/scene/draws/lighting.hpp"
#include "engine/scene/draws/missing.hpp"
#include "engine/scene/draws/models.hpp"
#include "engine/scene/draws/seen.hpp"
#include "engine/scene/draws/shown_nodes.hpp"
#include "engine/scene/draws/views.hpp"
#include "engine/scene/systems.hpp"
#include "engine/world/far/tree_pictures.hpp"

namespace psygen::scene {
namespace {

// How everything is drawn in this tick.
struct DrawTick {
  render::View shown = render::View::kNormal;
  FadeStep step;
  float fine_m = 0;  // blocks nearer than this have their finest ground
};

glm::vec3 corner_of(const visibility::NodeCoord& node, const Camera& camera,
                    const WorldFacts& facts) {
  return glm::vec3(core::offset_m(visibility::corner_block(node), camera.pose.position,
                                  facts.world.block_size_m()));
}

// Of the meshes that the node and its models draw.
float bytes_per_m2(const RenderQuery& entities, ecs::Entity node, float side_m) {
  std::uint64_t bytes = 0;
  const auto add = [&](std::span<const ecs::Entity>, std::span<const Demand> demands,
                       std::span<const Mesh> meshes) {
    for (std::size_t i = 0; i < meshes.size(); ++i)
      bytes += demands[i].drawn_level != kNoLevel ? meshes[i].range.bytes : 0;
  };
  entities.each_of<const Demand, const Mesh>(std::span(&node, 1), add);
  entities.each_of<const Demand, const Mesh>(entities.children(*entities.get<ecs::Children>(node)),
                                             add);
  return static_cast<float>(bytes) / (side_m * side_m);
}

// A node of the grid, drawn in this tick or until the last one, whose entity is alive.
ModelGround ground_of(const DrawTick& tick, const WorldFacts& facts, const RenderQuery& entities,
                      ecs::Entity entity, std::uint8_t level, glm::vec3 corner, float side_m,
                      std::uint32_t coarser) {
  DrawFacts said{level, entities.get<Visibility>(entity)->layer, 0, coarser};
  if (tick.shown == render::View::kCache)
    said.bytes_per_m2 = bytes_per_m2(entities, entity, side_m);
  return {corner,
          side_m,
          entities.get<GroundSun>(entity),
          said,
          tick.shown,
          tick.step,
          facts.shadows,
          facts.near_detail,
          facts.pictures && level > 0 && level <= world::kMaxPicturedLevel};
}

// The models of a node that is drawn no more; false once they are gone, or out of view.
bool draw_going(const DrawTick& tick, const Camera& camera, const WorldFacts& facts,
                const Streaming& streaming, const View& view, const RenderQuery& entities,
                const visibility::NodeCoord& node, DrawLists& draws) {
  const NodeGrid& grid = streaming.grids[node.level];
  if (!grid.contains(node.coord)) return false;
  const ecs::Entity entity = grid.entity_of(node.coord);
  if (!entities.alive(entity)) return false;
  const Node& at = *entities.get<Node>(entity);
  const glm::vec3 corner = corner_of(node, camera, facts);
  const float side_m = static_cast<float>(facts.levels[node.level].size_m);
  const glm::vec3 beyond(facts.models_reach_m.x, 0, facts.models_reach_m.x);
  const glm::vec3 opposite(side_m, at.high_m + facts.models_reach_m.y, side_m);
  if (!can_be_seen({corner + glm::vec3(0, at.low_m, 0) - beyond, corner + opposite + beyond}, view))
    return false;
  const ModelGround ground =
      ground_of(tick, facts, entities, entity, node.level, corner, side_m, 0);
  return add_going_models(ground, view, entities, *entities.get<ecs::Children>(entity), draws);
}

NodeEntry entry_of(const NodeHandover& handover, const visibility::NodeCoord& node) {
  if (!handover.is_fresh(node)) return NodeEntry::kStays;
  return handover.replaces(node) ? NodeEntry::kReplaces : NodeEntry::kEnters;
}

// A node in view that has no entity yet, and no ancestor that stands for it.
void count_missing(const Camera& camera, const WorldFacts& facts, const visibility::NodeCoord& node,
                   Counters& counters) {
  const core::Bounds& box = facts.levels[node.level].bounds;
  count_seen(camera,
             {.centre = corner_of(node, camera, facts) + box.centre(),
              .radius_m = glm::length(box.half_extent()),
              .hole = true,
              .awaits = false},
             counters);
}

void add_ground(const DrawTick& tick, const WorldFacts& facts, const View& view,
                const visibility::CutNode& node, const ModelGround& ground,
                const RenderQuery& entities, ecs::Entity entity, DrawLists& draws) {
  const auto [placed, demand, mesh, relief] =
      std::tuple(entities.get<Placed>(entity), entities.get<Demand>(entity),
                 entities.get<Mesh>(entity), entities.get<GroundRelief>(entity));
  const NodeLevel& level = facts.levels[node.node.level];
  render::TerrainDraw draw;
  draw.range = mesh->range;
  draw.shared_indices = mesh->shared_indices;
  draw.origin = ground.corner;
  draw.cell_m = facts.cell_m * static_cast<float>(1U << node.node.level);
  draw.height_min_m = placed->box_centre.y - placed->box_half_extent.y;
  draw.height_range_m = 2 * placed->box_half_extent.y;
  draw.skirt_m = level.skirt_m;
  draw.side_m = node.side_m;
  if (node.node.level > 0 && !level.merged) draw.cover = facts.cover_share;
  draw.debug_colour = colour_of(tick.shown, ground.node);
  // A mesh coarser than wanted has nothing to morph from.
  draw.morph = level.mesh_level != 0 && node.leaf && !node.fine ? node.morph : 0.0F;
  draws.meshes.push_back(mesh->handle);
  const std::size_t mesh_level =
      (node.node.level > 0 ? level.mesh_level : 0U) + demand->drawn_level;
  const NodeTiles tiles{facts.grids[mesh_level], *relief, ground.corner, draw.cell_m,
                        entities.get<Node>(entity)->low_m - level.skirt_m};
  const bool fine = facts.tiles && mesh_level == 0;
  const bool all = facts.shadows || overhangs(facts.world, node.node);
  const std::uint32_t in_view = all ? kAllTiles : tiles_in_view(tiles, view);
  add_tiles(tiles, in_view, fine ? &*facts.tiles : nullptr, tick.fine_m, draw, draws.terrain);
}

// The node `index` of the cut, with its models.
void draw_node(const DrawTick& tick, const Camera& camera, const WorldFacts& facts,
               const Streaming& streaming, const View& view, const RenderQuery& entities,
               std::uint32_t index, DrawLists& draws, Counters& counters) {
  const visibility::CutNode& node = view.cut.nodes[index];
  const ecs::Entity entity = draws.entities[index];
  if (!entities.alive(entity)) return count_missing(camera, facts, node.node, counters);
  const Demand& demand = *entities.get<Demand>(entity);
  const Node& at = *entities.get<Node>(entity);
  const glm::vec3 corner = corner_of(node.node, camera, facts);
  const bool hole = demand.drawn_level == kNoLevel;
  const std::uint32_t coarser = node.leaf ? 0 : coarser_by(view, index);
  const float min_m =
      min_distance_m(node, demand.drawn_level, streaming.distances[node.node.level].split_m);
  const bool twice = !hole && min_m > 0 && nearest_m(view, index, corner.y + at.high_m) < min_m;
  count_seen(
      camera,
      {.centre = corner + glm::vec3(node.side_m / 2, (at.low_m + at.high_m) / 2, node.side_m / 2),
       .radius_m = entities.get<Placed>(entity)->radius_m,
       .hole = hole,
       .coarse = coarser > 1,
       .twice = twice,
       .awaits = demand.failed_levels == 0},
      counters);
  const ModelGround ground =
      ground_of(tick, facts, entities, entity, node.node.level, corner, node.side_m, coarser);
  if (!hole) add_ground(tick, facts, view, node, ground, entities, entity, draws);
  add_models(ground, entry_of(draws.handover, node.node), twice, camera, view, entities,
             *entities.get<ecs::Children>(entity), draws, counters);
  if (tick.shown == render::View::kBounds) {
    add_box({corner + glm::vec3(0, at.low_m, 0),
             corner + glm::vec3(node.side_m, at.high_m, node.side_m)},
            colour_of(tick.shown, ground.node), draws.lines);
  }
}

// A clock that stands still does not stop what fades.
FadeStep fade_step(const Settings& settings, const Clock& clock, const DrawLists& draws) {
  constexpr double kMinSeconds = 1.0 / 240.0;
  const double passed_s = std::max(clock.now_s - draws.now_s, kMinSeconds);
  const bool at_once = settings.fade_seconds <= passed_s;
  return {clock.tick, at_once ? 1.0F : static_cast<float>(passed_s / settings.fade_seconds)};
}

}  // namespace

void render_system(const Settings& settings, const Input& input, const Clock& clock,
                   const Camera& camera, const Quality& quality, const WorldFacts& facts,
                   const Streaming& streaming, const View& view, const ObjectDraws& objects,
                   const LightDraws& lights, const ParticleDraws& particles, RenderQuery entities,
                   synthesis::MeshSupply& meshes, DrawLists& draws, Output& output,
                   Pressure& pressure, Counters& counters) {
  draws.terrain.clear();
  draws.models.clear();
  draws.meshes.clear();
  draws.lines.assign(input.lines.begin(), input.lines.end());
  draws.entities.clear();
  for (const visibility::CutNode& node : view.cut.nodes)
    draws.entities.push_back(streaming.grids[node.node.level].entity_of(node.node.coord));
  const render::Morph morph = morph_of(streaming);
  const DrawTick tick{input.view, fade_step(settings, clock, draws), morph.to_m};
  find_ready(view, entities, draws);
  visibility::drawn_nodes(view.cut, draws.ready, draws.scratch, draws.nodes);
  list_shown(view, draws);
  draws.handover.update(draws.shown_nodes, draws.tick + 1 == clock.tick);
  draws.handover.for_each_going([&](const visibility::NodeCoord& node) {
    return draw_going(tick, camera, facts, streaming, view, entities, node, draws);
  });
  for (const std::uint32_t i : draws.shown)
    draw_node(tick, camera, facts, streaming, view, entities, i, draws, counters);
  draws.tick = clock.tick;
  draws.now_s = clock.now_s;
  draws.fade_phase = next_phase(draws.fade_phase, tick.step);
  counters.missing_pixels_percent = std::min(counters.missing_pixels_percent, 100.0);
  pressure.awaited = counters.awaited;
  meshes.note_drawn(draws.meshes);
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
  frame.resolution = static_cast<float>(quality.resolution);
  frame.block_size_m = facts.world.block_size_m();
  frame.terrain = draws.terrain;
  frame.models = draws.models;
  frame.objects = objects.objects;
  frame.point_lights = lights.lights;
  frame.particles = particles.emitters;
  draws.spots.clear();
  add_spots_near(camera, facts, view, draws.entities, entities,
                 glm::normalize(frame.light.sun_direction), draws.spots);
  frame.spots = draws.spots;
  frame.lines = draws.lines;
  frame.canopy = facts.canopy;
  frame.morph = morph;
  frame.fade_phase = draws.fade_phase;
  frame.edge = edge_of(facts.world, camera.pose.position);
  frame.hud = &input.hud;
  frame.panels = input.panels;
  frame.gui = input.gui;
  frame.text_scale = input.text_scale;
  const auto result = output.renderer->render(frame);
  if (result) {
    counters.frame = *result;
  } else {
    output.error = result.error();
  }
}

}  // namespace psygen::scene
