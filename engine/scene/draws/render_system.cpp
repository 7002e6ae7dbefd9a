// Fills the draw lists from nodes in view with ready meshes, nearest first, measures missing
// detail, and hands the lists to the renderer. Where nodes of the cut are not ready, an ancestor is
// drawn until all its replacements are. Where no node is complete, the finest ground closes the
// gap.
#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

#include "engine/render/renderer.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/draws/contact_shadows.hpp"
#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/draws/ground.hpp"
#include "engine/scene/draws/models.hpp"
#include "engine/scene/draws/shown_nodes.hpp"
#include "engine/scene/facts/lighting.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/view/debug_colours.hpp"
#include "engine/scene/view/visibility.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::scene {
namespace {

// The tick's values for all draws.
struct DrawTick {
  render::View shown = render::View::kNormal;
  FadeStep step;
  float fine_m = 0;  // nearer blocks have their finest ground
};

// Bytes per square metre of the meshes that the node and its models draw.
float bytes_per_m2(const RenderQuery& entities, ecs::Entity node, float side_m) {
  std::uint64_t bytes = 0;
  const auto add = [&](auto, auto demands, auto meshes) {
    for (std::size_t i = 0; i < meshes.size(); ++i)
      bytes += demands[i].drawn_level != kNoLevel ? meshes[i].range.bytes : 0;
  };
  entities.each_of<const MeshDemand, const Mesh>(std::span(&node, 1), add);
  entities.each_of<const MeshDemand, const Mesh>(
      entities.children(*entities.get<ecs::Children>(node)), add);
  return static_cast<float>(bytes) / (side_m * side_m);
}

// A node of the grid, drawn in this tick or until the last one, whose entity is alive.
struct DrawnNode {
  ecs::Entity entity;
  std::uint8_t level = 0;
  glm::vec3 corner{0.0F};  // relative to the camera
  float side_m = 0;
  std::uint32_t coarser = 0;  // levels by which it is coarser than wanted
};

ModelGround ground_of(const DrawTick& tick, const WorldFacts& facts, const RenderQuery& entities,
                      const DrawnNode& node) {
  ModelGround ground;
  ground.corner = node.corner;
  ground.side_m = node.side_m;
  ground.sun = entities.get<GroundSunlight>(node.entity);
  ground.node = {node.level, entities.get<Visibility>(node.entity)->layer, 0, node.coarser};
  if (tick.shown == render::View::kCache)
    ground.node.bytes_per_m2 = bytes_per_m2(entities, node.entity, node.side_m);
  ground.shown = tick.shown;
  ground.step = tick.step;
  ground.shadows = facts.shadows;
  ground.near_detail = facts.near_detail;
  ground.pictures = facts.pictures && node.level > 0 && node.level <= world::kMaxImpostorLevel;
  return ground;
}

// Draws the models of a node that is no longer drawn. Returns false once they have faded out or
// left the view.
bool draw_going(const DrawTick& tick, const RenderContext& context, const RenderQuery& entities,
                const visibility::NodeCoord& node, DrawLists& draws) {
  const WorldFacts& facts = context.facts;
  const NodeGrid& grid = context.streaming.grids[node.level];
  if (!grid.contains(node.coord)) return false;
  const ecs::Entity entity = grid.entity_of(node.coord);
  if (!entities.alive(entity)) return false;
  const QuadtreeNode& at = *entities.get<QuadtreeNode>(entity);
  const glm::vec3 corner = corner_of(node, context.camera, facts);
  const float side_m = static_cast<float>(facts.levels[node.level].size_m);
  const glm::vec3 beyond(facts.models_reach_m.x, 0, facts.models_reach_m.x);
  const glm::vec3 opposite(side_m, at.high_m + facts.models_reach_m.y, side_m);
  if (!may_be_visible({corner + glm::vec3(0, at.low_m, 0) - beyond, corner + opposite + beyond},
                      context.view))
    return false;
  const ModelGround ground =
      ground_of(tick, facts, entities, {entity, node.level, corner, side_m, 0});
  return add_going_models(ground, context.view, entities, *entities.get<ecs::Children>(entity),
                          draws);
}

NodeEntry entry_of(const NodeCrossFade& cross_fade, const visibility::NodeCoord& node) {
  if (!cross_fade.is_new_node(node)) return NodeEntry::kStays;
  return cross_fade.replaces(node) ? NodeEntry::kReplaces : NodeEntry::kEnters;
}

// Counts a node in view that has no entity yet, and no ancestor to draw in its place.
void count_missing(const RenderContext& context, const visibility::NodeCoord& node,
                   DrawCounts& counts) {
  const core::Bounds& box = context.facts.levels[node.level].bounds;
  count_visible(context.camera,
                {.centre = corner_of(node, context.camera, context.facts) + box.centre(),
                 .radius_m = glm::length(box.half_extent()),
                 .hole = true,
                 .awaits = false},
                counts);
}

void add_ground(const DrawTick& tick, const RenderContext& context, const visibility::CutNode& node,
                const ModelGround& ground, const RenderQuery& entities, ecs::Entity entity,
                DrawLists& draws) {
  const WorldFacts& facts = context.facts;
  const auto [placed, demand, mesh, occluder] =
      std::tuple(entities.get<MeshPlacement>(entity), entities.get<MeshDemand>(entity),
                 entities.get<Mesh>(entity), entities.get<GroundOccluder>(entity));
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
  // A mesh coarser than wanted has no finer mesh to morph from.
  draw.morph = level.mesh_level != 0 && node.leaf && !node.fine ? node.morph : 0.0F;
  draws.meshes.push_back(mesh->handle);
  const std::size_t mesh_level =
      (node.node.level > 0 ? level.mesh_level : 0U) + demand->drawn_level;
  const NodeTiles tiles{facts.grids[mesh_level], *occluder, ground.corner, draw.cell_m,
                        entities.get<QuadtreeNode>(entity)->low_m - level.skirt_m};
  const bool fine = facts.tiles && mesh_level == 0;
  const bool all = facts.shadows || overhangs(facts.world, node.node);
  const std::uint32_t in_view = all ? kAllTiles : tiles_in_view(tiles, context.view);
  add_tiles(tiles, in_view, fine ? &*facts.tiles : nullptr, tick.fine_m, draw, draws.terrain);
}

// Draws the node `index` of the cut, with its models.
void draw_node(const DrawTick& tick, const RenderContext& context, const RenderQuery& entities,
               std::uint32_t index, DrawLists& draws) {
  const View& view = context.view;
  const visibility::CutNode& node = view.cut.nodes[index];
  const ecs::Entity entity = draws.entities[index];
  if (!entities.alive(entity)) return count_missing(context, node.node, draws.counts);
  const MeshDemand& demand = *entities.get<MeshDemand>(entity);
  const QuadtreeNode& at = *entities.get<QuadtreeNode>(entity);
  const glm::vec3 corner = corner_of(node.node, context.camera, context.facts);
  const bool hole = demand.drawn_level == kNoLevel;
  const std::uint32_t coarser = node.leaf ? 0 : coarser_by(view, index);
  const float min_m = min_distance_m(node, demand.drawn_level,
                                     context.streaming.distances[node.node.level].split_m);
  const bool twice = !hole && min_m > 0 && nearest_m(view, index, corner.y + at.high_m) < min_m;
  count_visible(
      context.camera,
      {.centre = corner + glm::vec3(node.side_m / 2, (at.low_m + at.high_m) / 2, node.side_m / 2),
       .radius_m = entities.get<MeshPlacement>(entity)->radius_m,
       .hole = hole,
       .coarse = coarser > 1,
       .twice = twice,
       .awaits = demand.failed_levels == 0},
      draws.counts);
  const ModelGround ground = ground_of(tick, context.facts, entities,
                                       {entity, node.node.level, corner, node.side_m, coarser});
  if (!hole) add_ground(tick, context, node, ground, entities, entity, draws);
  add_models(ground, entry_of(draws.cross_fade, node.node), twice, context, entities,
             *entities.get<ecs::Children>(entity), draws);
  add_water(ground, context, entities, *entities.get<ecs::Children>(entity), draws);
  if (tick.shown == render::View::kBounds) {
    add_box({corner + glm::vec3(0, at.low_m, 0),
             corner + glm::vec3(node.side_m, at.high_m, node.side_m)},
            colour_of(tick.shown, ground.node), draws.lines);
  }
}

// Fills the lists of ground and models, and counts what they lack.
void fill_lists(const RenderContext& context, const render::Morph& morph,
                const RenderQuery& entities, DrawLists& draws) {
  const View& view = context.view;
  draws.terrain.clear();
  draws.models.clear();
  draws.water.clear();
  draws.meshes.clear();
  draws.lines.assign(context.input.lines.begin(), context.input.lines.end());
  draws.entities.clear();
  for (const visibility::CutNode& node : view.cut.nodes)
    draws.entities.push_back(context.streaming.grids[node.node.level].entity_of(node.node.coord));
  const DrawTick tick{context.input.view, next_fade_step(context.frame, draws.last), morph.to_m};
  find_ready(view, entities, draws);
  visibility::drawn_nodes(view.cut, draws.ready, draws.scratch, draws.nodes);
  list_shown(view, draws);
  draws.cross_fade.update(draws.shown_nodes, tick.step.continues);
  draws.cross_fade.for_each_going([&](const visibility::NodeCoord& node) {
    return draw_going(tick, context, entities, node, draws);
  });
  for (const std::uint32_t i : draws.shown)
    draw_node(tick, context, entities, i, draws);
  std::ranges::reverse(draws.water);  // nodes come nearest first
  draws.fade_phase = next_phase(draws.fade_phase, tick.step);
  draws.counts.missing_pixels_percent = std::min(draws.counts.missing_pixels_percent, 100.0);
}

}  // namespace

void render_system(RenderContext context, SceneDraws scene, RenderQuery entities, DrawWork work) {
  const WorldFacts& facts = context.facts;
  const Input& input = context.input;
  const Clock& clock = context.frame.clock;
  DrawLists& draws = work.draws;
  const render::Morph morph = morph_of(context.streaming);
  fill_lists(context, morph, entities, draws);
  work.pressure.awaited = draws.counts.awaited;
  work.supply.note_drawn(draws.meshes);
  if (work.output.renderer == nullptr) return;

  render::FrameInput frame;
  frame.pose = context.camera.pose;
  frame.projection = context.camera.projection;
  frame.light = facts.light;
  if (facts.world.sky.day_length_s > 0) move_sun(facts.world, clock.now_s, frame.light);
  frame.light.time_seconds = static_cast<float>(clock.now_s);
  frame.palette = facts.palette;
  frame.water = water_of(facts.world);
  frame.water_colour = facts.world.water.colour;
  frame.water_surfaces = draws.water;
  frame.view = input.view;
  frame.resolution = static_cast<float>(context.quality.resolution);
  frame.block_size_m = facts.world.block_size_m();
  frame.terrain = draws.terrain;
  frame.models = draws.models;
  frame.objects = scene.objects.objects;
  frame.point_lights = scene.lights.lights;
  frame.particles = scene.particles.emitters;
  draws.spots.clear();
  add_spots_near(context, draws.entities, entities, glm::normalize(frame.light.sun_direction),
                 draws.spots);
  frame.spots = draws.spots;
  frame.lines = draws.lines;
  frame.canopy = facts.canopy;
  frame.morph = morph;
  frame.fade_phase = draws.fade_phase;
  frame.edge = edge_of(facts.world, context.camera.pose.position);
  frame.hud = &input.hud;
  frame.panels = input.panels;
  frame.gui = input.gui;
  frame.text_scale = input.text_scale;
  const auto result = work.output.renderer->render(frame);
  if (result) {
    draws.frame = *result;
  } else {
    work.output.error = result.error();
  }
}

}  // namespace psygen::scene
