// Turns what is in view and resident into draw lists, nearest nodes first, counts what is missing,
// and hands the lists to the renderer. Where nodes of the cut are not ready an ancestor is drawn
// until all that replaces it is; where nothing is complete, the finest ground that closes the gap.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/draws/ground.hpp"
#include "engine/scene/draws/lighting.hpp"
#include "engine/scene/draws/missing.hpp"
#include "engine/scene/draws/models.hpp"
#include "engine/scene/draws/seen.hpp"
#include "engine/scene/draws/views.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

class Drawing {
 public:
  Drawing(render::View shown, FadeStep step, const Camera& camera, const WorldFacts& facts,
          const Streaming& streaming, const View& view, float fine_m, const RenderQuery& entities,
          DrawLists& draws, Counters& counters)
      : shown_(shown),
        camera_(camera),
        facts_(facts),
        distances_(streaming.distances),
        view_(view),
        fine_m_(fine_m),
        entities_(entities),
        draws_(draws),
        counters_(counters),
        models_(shown, step, camera, facts, view, entities, draws, counters) {}

  // Entities of the nodes of the cut, in its order; null where there is none. `continues`: the last
  // tick was drawn too.
  void run(std::span<const ecs::Entity> entities, const Streaming& streaming, bool continues) {
    find_ready(entities);
    visibility::drawn_nodes(view_.cut, draws_.ready, draws_.scratch, draws_.nodes);
    list_shown();
    draws_.handover.update(draws_.shown_nodes, continues);
    draws_.handover.for_each_going(
        [&](const visibility::NodeCoord& node) { return draw_going(node, streaming); });
    for (const std::uint32_t i : draws_.shown)
      draw(i, entities[i]);
  }

 private:
  // What the visibility system found, as its ground is what hides others: without what was evicted
  // since, and what has become complete since only where nothing above it is drawn.
  void find_ready(std::span<const ecs::Entity> entities) {
    const std::vector<visibility::CutNode>& cut = view_.cut.nodes;
    draws_.ready.assign(cut.size(), 0);
    std::vector<std::uint8_t>& covered = draws_.scratch;  // by the node or an ancestor
    covered.assign(cut.size(), 0);
    for (std::size_t i = 0; i < cut.size(); ++i) {
      const bool above = cut[i].parent != visibility::kNoNode && covered[cut[i].parent] != 0;
      const Demand* demand = entities_.get<Demand>(entities[i]);
      const bool ground = demand != nullptr && demand->drawn_level != kNoLevel;
      draws_.ready[i] = ground && (view_.ready[i] != 0 || !above) ? 1 : 0;
      covered[i] = above || draws_.ready[i] != 0 ? 1 : 0;
    }
  }

  void list_shown() {
    const std::vector<visibility::CutNode>& cut = view_.cut.nodes;
    draws_.shown.clear();
    draws_.shown_nodes.clear();
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < cut.size();) {
      const bool drawn = next < draws_.nodes.size() && draws_.nodes[next] == i;
      // What has no ancestor to stand for it is drawn as far as it goes.
      if ((drawn || cut[i].leaf) && view_.in_view[i] != 0) {
        draws_.shown.push_back(i);
        draws_.shown_nodes.push_back(cut[i].node);
      }
      next += drawn ? 1 : 0;
      i = drawn ? cut[i].end : i + 1;
    }
  }

  glm::vec3 corner_of(const visibility::NodeCoord& node) const {
    return glm::vec3(core::offset_m(visibility::corner_block(node), camera_.pose.position,
                                    facts_.world.block_size_m()));
  }

  // The models of a node that is drawn no more; false once they are gone, or out of view.
  bool draw_going(const visibility::NodeCoord& node, const Streaming& streaming) {
    const NodeGrid& grid = streaming.grids[node.level];
    if (!grid.contains(node.coord)) return false;
    const ecs::Entity entity = grid.entity_of(node.coord);
    if (!entities_.alive(entity)) return false;
    const Node& at = *entities_.get<Node>(entity);
    const glm::vec3 corner = corner_of(node);
    const float side_m = static_cast<float>(facts_.levels[node.level].size_m);
    const glm::vec3 beyond(facts_.models_reach_m.x, 0, facts_.models_reach_m.x);
    const glm::vec3 opposite(side_m, at.high_m + facts_.models_reach_m.y, side_m);
    if (!can_be_seen({corner + glm::vec3(0, at.low_m, 0) - beyond, corner + opposite + beyond},
                     view_))
      return false;
    DrawFacts facts{node.level, entities_.get<Visibility>(entity)->layer, 0, 0};
    if (shown_ == render::View::kCache) facts.bytes_per_m2 = bytes_per_m2(entity, side_m);
    return models_.add_going(*entities_.get<ecs::Children>(entity), facts,
                             {corner, side_m, *entities_.get<GroundSun>(entity)});
  }

  ModelDraws::Node how_drawn(const visibility::NodeCoord& node) const {
    if (!draws_.handover.is_fresh(node)) return ModelDraws::Node::kStays;
    return draws_.handover.replaces(node) ? ModelDraws::Node::kReplaces : ModelDraws::Node::kEnters;
  }

  void draw(std::uint32_t index, ecs::Entity entity) {
    const visibility::CutNode& node = view_.cut.nodes[index];
    if (!entities_.alive(entity)) return count_missing(node.node);
    const auto [placed, demand] =
        std::tuple(entities_.get<Placed>(entity), entities_.get<Demand>(entity));
    const Node& at = *entities_.get<Node>(entity);
    const glm::vec3 corner = corner_of(node.node);
    const glm::vec3 middle =
        corner + glm::vec3(node.side_m / 2, (at.low_m + at.high_m) / 2, node.side_m / 2);
    const bool hole = demand->drawn_level == kNoLevel;
    const std::uint32_t coarser = node.leaf ? 0 : coarser_by(index);
    const float least_m = least_distance_m(node, *demand);
    const bool twice = !hole && least_m > 0 && nearest_m(index, corner.y + at.high_m) < least_m;
    count_seen(camera_,
               {.center = middle,
                .radius_m = placed->radius_m,
                .hole = hole,
                .coarse = coarser > 1,
                .twice = twice,
                .awaits = demand->failed_levels == 0},
               counters_);
    DrawFacts facts{node.node.level, entities_.get<Visibility>(entity)->layer, 0, coarser};
    if (shown_ == render::View::kCache) facts.bytes_per_m2 = bytes_per_m2(entity, node.side_m);
    if (!hole) add_ground(node, entity, at, facts, corner);
    models_.add(*entities_.get<ecs::Children>(entity), how_drawn(node.node), facts,
                {corner, node.side_m, *entities_.get<GroundSun>(entity)}, twice);
    if (shown_ == render::View::kBounds) {
      add_box({corner + glm::vec3(0, at.low_m, 0),
               corner + glm::vec3(node.side_m, at.high_m, node.side_m)},
              colour_of(shown_, facts), draws_.lines);
    }
  }

  // A node in view that has no entity yet, and no ancestor that stands for it.
  void count_missing(const visibility::NodeCoord& node) {
    const core::Bounds& box = facts_.levels[node.level].bounds;
    count_seen(camera_,
               {.center = corner_of(node) + box.center(),
                .radius_m = glm::length(box.half_extent()),
                .hole = true,
                .awaits = false},
               counters_);
  }

  // Of the meshes that the node and its models draw.
  float bytes_per_m2(ecs::Entity node, float side_m) const {
    std::uint64_t bytes = 0;
    const auto add = [&](std::span<const ecs::Entity>, std::span<const Demand> demands,
                         std::span<const Mesh> meshes) {
      for (std::size_t i = 0; i < meshes.size(); ++i)
        bytes += demands[i].drawn_level != kNoLevel ? meshes[i].range.bytes : 0;
    };
    entities_.each_of<const Demand, const Mesh>(std::span(&node, 1), add);
    entities_.each_of<const Demand, const Mesh>(
        entities_.children(*entities_.get<ecs::Children>(node)), add);
    return static_cast<float>(bytes) / (side_m * side_m);
  }

  // Half of the distance up to which a node's mesh is finer than what is drawn of it: nearer, that
  // has more than twice the error that it might have. 0 for what is drawn as wanted.
  float least_distance_m(const visibility::CutNode& node, const Demand& demand) const {
    const bool as_wanted = node.leaf && (!node.fine || demand.drawn_level == 0);
    return as_wanted ? 0.0F : static_cast<float>(distances_[node.node.level].split_m / 2);
  }

  // How near the camera comes to what is in view of a node whose ground is at most so high above
  // it.
  float nearest_m(std::uint32_t index, float highest_m) const {
    const std::vector<visibility::CutNode>& cut = view_.cut.nodes;
    float nearest = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = index; i < cut[index].end; ++i) {
      if (cut[i].leaf && view_.in_view[i] != 0) nearest = std::min(nearest, cut[i].distance_m);
    }
    return std::hypot(nearest, std::max(-highest_m, 0.0F));
  }

  // By how many levels the finest node in view that it is drawn for is finer.
  std::uint32_t coarser_by(std::uint32_t index) const {
    const visibility::CutNode& node = view_.cut.nodes[index];
    std::uint32_t finest = node.node.level;
    for (std::uint32_t i = index + 1; i < node.end; ++i) {
      if (view_.in_view[i] != 0)
        finest = std::min<std::uint32_t>(finest, view_.cut.nodes[i].node.level);
    }
    return node.node.level - finest;
  }

  void add_ground(const visibility::CutNode& node, ecs::Entity entity, const Node& at,
                  const DrawFacts& facts, glm::vec3 corner) {
    const auto [placed, demand, mesh, relief] =
        std::tuple(entities_.get<Placed>(entity), entities_.get<Demand>(entity),
                   entities_.get<Mesh>(entity), entities_.get<GroundRelief>(entity));
    const NodeLevel& level = facts_.levels[node.node.level];
    render::TerrainDraw draw;
    draw.range = mesh->range;
    draw.shared_indices = mesh->shared_indices;
    draw.origin = corner;
    draw.cell_m = facts_.cell_m * static_cast<float>(1U << node.node.level);
    draw.height_min_m = placed->box_center.y - placed->box_half_extent.y;
    draw.height_range_m = 2 * placed->box_half_extent.y;
    draw.skirt_m = level.skirt_m;
    draw.side_m = node.side_m;
    if (node.node.level > 0 && !level.merged) draw.cover = facts_.cover_share;
    draw.debug_colour = colour_of(shown_, facts);
    // A mesh coarser than wanted has nothing to morph from.
    draw.morph = level.mesh_level != 0 && node.leaf && !node.fine ? node.morph : 0.0F;
    draws_.meshes.push_back(mesh->handle);
    const std::size_t mesh_level =
        (node.node.level > 0 ? level.mesh_level : 0U) + demand->drawn_level;
    const NodeTiles tiles{facts_.grids[mesh_level], *relief, corner, draw.cell_m,
                          at.low_m - level.skirt_m};
    const bool fine = facts_.tiles && mesh_level == 0;
    const bool all = facts_.shadows || overhangs(facts_.world, node.node);
    const std::uint32_t in_view = all ? kAllTiles : tiles_in_view(tiles, view_);
    add_tiles(tiles, in_view, fine ? &*facts_.tiles : nullptr, fine_m_, draw, draws_.terrain);
  }

  const render::View shown_;
  const Camera& camera_;
  const WorldFacts& facts_;
  const std::span<const visibility::LevelDistances> distances_;
  const View& view_;
  const float fine_m_;  // blocks nearer than this have their finest ground
  const RenderQuery& entities_;
  DrawLists& draws_;
  Counters& counters_;
  ModelDraws models_;
};

// A clock that stands still does not stop what fades.
FadeStep fade_step(const Settings& settings, const Clock& clock, const DrawLists& draws) {
  constexpr double kLeastSeconds = 1.0 / 240.0;
  const double passed_s = std::max(clock.now_s - draws.now_s, kLeastSeconds);
  const bool at_once = settings.fade_seconds <= passed_s;
  return {clock.tick, at_once ? 1.0F : static_cast<float>(passed_s / settings.fade_seconds)};
}

}  // namespace

void render_system(const Settings& settings, const Input& input, const Clock& clock,
                   const Camera& camera, const WorldFacts& facts, const Streaming& streaming,
                   const View& view, RenderQuery entities, synthesis::MeshSupply& meshes,
                   DrawLists& draws, Output& output, Pressure& pressure, Counters& counters) {
  draws.terrain.clear();
  draws.models.clear();
  draws.meshes.clear();
  draws.lines.clear();
  draws.entities.clear();
  for (const visibility::CutNode& node : view.cut.nodes)
    draws.entities.push_back(streaming.grids[node.node.level].entity_of(node.node.coord));
  const render::Morph morph = morph_of(streaming);
  Drawing(input.view, fade_step(settings, clock, draws), camera, facts, streaming, view, morph.to_m,
          entities, draws, counters)
      .run(draws.entities, streaming, draws.tick + 1 == clock.tick);
  draws.tick = clock.tick;
  draws.now_s = clock.now_s;
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
  frame.block_size_m = facts.world.block_size_m();
  frame.terrain = draws.terrain;
  frame.models = draws.models;
  frame.lines = draws.lines;
  frame.canopy = facts.canopy;
  frame.morph = morph;
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
