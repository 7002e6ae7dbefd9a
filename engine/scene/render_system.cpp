// Turns what is in view and resident into draw lists, nearest nodes first, counts what is missing,
// and hands the lists to the renderer. Where nodes of the cut are not ready an ancestor is drawn
// until all that replaces it is; where nothing is complete, the finest ground that closes the gap.
#include <algorithm>

#include "engine/scene/ground_draws.hpp"
#include "engine/scene/lighting.hpp"
#include "engine/scene/mesh_parts.hpp"
#include "engine/scene/missing.hpp"
#include "engine/scene/systems.hpp"
#include "engine/scene/views.hpp"

namespace psygen::scene {
namespace {

class Drawing {
 public:
  Drawing(render::View shown, const Clock& clock, const Camera& camera, const WorldFacts& facts,
          const View& view, float fine_m, const RenderQuery& entities, DrawLists& draws,
          Counters& counters)
      : shown_(shown),
        clock_(clock),
        camera_(camera),
        facts_(facts),
        view_(view),
        fine_m_(fine_m),
        entities_(entities),
        draws_(draws),
        counters_(counters) {}

  // Entities of the nodes of the cut, in its order; null where there is none.
  void run(std::span<const ecs::Entity> entities) {
    const std::vector<visibility::CutNode>& cut = view_.cut.nodes;
    find_ready(entities);
    visibility::drawn_nodes(view_.cut, draws_.ready, draws_.scratch, draws_.nodes);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < cut.size();) {
      const bool drawn = next < draws_.nodes.size() && draws_.nodes[next] == i;
      // What has no ancestor to stand for it is drawn as far as it goes.
      if ((drawn || cut[i].leaf) && view_.in_view[i] != 0) draw(i, entities[i]);
      next += drawn ? 1 : 0;
      i = drawn ? cut[i].end : i + 1;
    }
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

  void draw(std::uint32_t index, ecs::Entity entity) {
    if (!entities_.alive(entity)) return;  // counted by the visibility system
    const visibility::CutNode& node = view_.cut.nodes[index];
    const auto [placed, demand] =
        std::tuple(entities_.get<Placed>(entity), entities_.get<Demand>(entity));
    const Node& at = *entities_.get<Node>(entity);
    const glm::vec3 corner(core::offset_m(visibility::corner_block(node.node),
                                          camera_.pose.position, facts_.world.block_size_m()));
    const glm::vec3 middle =
        corner + glm::vec3(node.side_m / 2, (at.low_m + at.high_m) / 2, node.side_m / 2);
    const bool hole = demand->drawn_level == kNoLevel;
    const std::uint32_t coarser = node.leaf ? 0 : coarser_by(index);
    count(middle, placed->radius_m, hole, coarser > 1);
    DrawFacts facts{node.node.level, entities_.get<Visibility>(entity)->layer, 0, coarser};
    if (shown_ == render::View::kCache) facts.bytes_per_m2 = bytes_per_m2(entity, node.side_m);
    if (!hole) add_ground(node, entity, at, facts, corner);
    add_models(*entities_.get<ecs::Children>(entity), facts, corner);
    if (shown_ == render::View::kBounds) {
      add_box({corner + glm::vec3(0, at.low_m, 0),
               corner + glm::vec3(node.side_m, at.high_m, node.side_m)},
              colour_of(shown_, facts), draws_.lines);
    }
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

  void count(glm::vec3 center, float radius_m, bool hole, bool coarse) {
    ++counters_.nodes_in_view;
    if (hole) ++counters_.holes;
    if (coarse) ++counters_.coarse;
    if (hole || coarse)
      counters_.missing_pixels_percent += covered_percent(camera_, center, radius_m);
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

  // `facts` are those of their node.
  void add_models(const ecs::Children& children, DrawFacts facts, glm::vec3 corner) {
    const bool single = facts.level == 0;
    entities_.each_of<const Placed, const Demand, const Mesh>(
        entities_.children(children),
        [&](std::span<const ecs::Entity> models, std::span<const Placed> placed,
            std::span<const Demand> demands, std::span<const Mesh> meshes) {
          for (std::size_t i = 0; i < placed.size(); ++i) {
            const Demand& demand = demands[i];
            if (demand.wanted_level == kNoLevel || demand.in_view_tick != clock_.tick) continue;
            const glm::vec3 foot = corner + placed[i].position;
            const bool hole = demand.drawn_level == kNoLevel;
            const bool coarse = !hole && demand.drawn_level > demand.wanted_level + 1;
            if (single && !hole) {
              facts.level = demand.drawn_level;
              facts.coarser =
                  static_cast<std::uint32_t>(std::max(demand.drawn_level - demand.wanted_level, 0));
            }
            const MeshParts* parts =
                single || facts_.shadows ? nullptr : entities_.get<MeshParts>(models[i]);
            const bool seen =
                hole || add_model(parts, foot, placed[i], meshes[i], colour_of(shown_, facts));
            if (seen) count(foot + placed[i].middle, placed[i].radius_m, hole, coarse);
          }
        });
  }

  // Where its parts are known only those that can be seen. Returns whether any can.
  bool add_model(const MeshParts* parts, glm::vec3 foot, const Placed& placed, const Mesh& mesh,
                 std::uint32_t debug_colour) {
    render::MeshDraw draw;
    draw.range = mesh.range;
    draw.shared_indices = mesh.shared_indices;
    draw.origin = foot;
    draw.box_center = placed.box_center;
    draw.box_half_extent = placed.box_half_extent;
    draw.debug_colour = debug_colour;
    if (parts == nullptr || parts->indices_each == 0) {
      draws_.models.push_back(draw);
    } else if (!add_parts(*parts, view_, draw, draws_.models)) {
      return false;
    }
    draws_.meshes.push_back(mesh.handle);
    return true;
  }

  const render::View shown_;
  const Clock& clock_;
  const Camera& camera_;
  const WorldFacts& facts_;
  const View& view_;
  const float fine_m_;  // blocks nearer than this have their finest ground
  const RenderQuery& entities_;
  DrawLists& draws_;
  Counters& counters_;
};

}  // namespace

void render_system(const Input& input, const Clock& clock, const Camera& camera,
                   const WorldFacts& facts, const Streaming& streaming, const View& view,
                   RenderQuery entities, DrawLists& draws, Output& output, Counters& counters) {
  draws.terrain.clear();
  draws.models.clear();
  draws.meshes.clear();
  draws.lines.clear();
  draws.entities.clear();
  for (const visibility::CutNode& node : view.cut.nodes)
    draws.entities.push_back(streaming.grids[node.node.level].entity_of(node.node.coord));
  const render::Morph morph = morph_of(streaming);
  Drawing(input.view, clock, camera, facts, view, morph.to_m, entities, draws, counters)
      .run(draws.entities);
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
  frame.lines = draws.lines;
  frame.canopy = facts.canopy;
  frame.morph = morph;
  frame.edge = edge_of(facts.world, camera.pose.position);
  frame.overlay_lines = input.overlay_lines;
  const auto result = output.renderer->render(frame);
  if (result) {
    counters.frame = *result;
  } else {
    output.error = result.error();
  }
}

}  // namespace psygen::scene
