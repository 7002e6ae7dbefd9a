#include "engine/scene/view/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {
namespace {

// LevelView::part of nodes in view, of siblings that must be ready with them, and of other roots
// and ancestors of leaves of the cut, which would be drawn first if the camera turned.
constexpr std::uint8_t kInView = 1, kBeside = 2, kAncestor = 3;

// The box of a node, with a margin for models that reach over its edge.
core::Bounds node_bounds(const WorldFacts& facts, const glm::vec3& corner, double size_m,
                         float low_m, float high_m) {
  const auto size = static_cast<float>(size_m);
  const float reach_m = facts.models_reach_m.x;
  return {corner + glm::vec3(-reach_m, low_m, -reach_m),
          corner + glm::vec3(size + reach_m, high_m + facts.models_reach_m.y, size + reach_m)};
}

// Squared distance to the nearest point of a box.
float distance_squared_to(const core::Bounds& box) {
  const glm::vec3 nearest = glm::clamp(glm::vec3(0.0F), box.min, box.max);
  return glm::dot(nearest, nearest);
}

visibility::Frustum frustum_of(const core::CameraPose& pose, const core::Projection& projection) {
  return visibility::make_frustum(core::projection_matrix(projection) * core::view_rotation(pose));
}

// Finds the boxes of all cells of all windows: the maximum extent of the ground where there is no
// node, or none with a mesh.
void find_bounds(const SceneSettings& settings, const Camera& camera, const WorldFacts& facts,
                 const Streaming& streaming, const VisibilityQuery& nodes, View& view) {
  const bool solid = settings.plp_mode == visibility::PlpMode::kSolidity;
  view.levels.resize(facts.levels.size());
  for (const NodeGrid& grid : streaming.grids) {
    const NodeLevel& level = facts.levels[grid.level()];
    std::vector<core::Bounds>& bounds = view.levels[grid.level()].bounds;
    bounds.clear();
    if (solid)
      view.levels[grid.level()].solidity.assign(std::size_t{grid.side()} * grid.side(), 0.0F);
    const glm::vec3 first = corner_of(grid.node_at(0, 0), camera, facts);
    const auto size = static_cast<float>(level.size_m);
    for (std::uint32_t row = 0; row < grid.side(); ++row) {
      for (std::uint32_t column = 0; column < grid.side(); ++column) {
        const glm::vec3 steps(static_cast<float>(column), 0.0F, static_cast<float>(row));
        bounds.push_back(node_bounds(facts, first + steps * size, level.size_m, level.bounds.min.y,
                                     level.bounds.max.y));
      }
    }
  }
  nodes.each<const QuadtreeNode>([&](auto, auto rows) {
    for (const QuadtreeNode& node : rows) {
      const std::size_t cell = streaming.grids[node.at.level].window_index(node.at.coord);
      if (solid) view.levels[node.at.level].solidity[cell] = node.solidity;
      view.levels[node.at.level].bounds[cell] =
          node_bounds(facts, corner_of(node.at, camera, facts), facts.levels[node.at.level].size_m,
                      node.low_m, node.high_m);
    }
  });
}

void project_layers(const SceneSettings& settings, const NodeGrid& grid,
                    const visibility::Frustum& frustum, LevelView& level) {
  visibility::PlpInput input;
  input.width = input.depth = grid.side();
  input.start_x = input.start_z = grid.radius();
  input.bounds = level.bounds;
  input.frustum = &frustum;
  input.mode = settings.plp_mode;
  input.solidity = level.solidity;
  visibility::run_plp(input, level.plp);
  level.deadlines.assign(level.bounds.size(), std::numeric_limits<float>::infinity());
  level.part.assign(level.bounds.size(), 0);
}

// Returns the time of the soonest predicted view that shows a node and comes near enough to need
// its detail.
float deadline_of(const core::Bounds& bounds, float reach_m,
                  std::span<const PredictedView> outlooks) {
  for (const PredictedView& outlook : outlooks) {
    const core::Bounds box{bounds.min - outlook.moved, bounds.max - outlook.moved};
    if (distance_squared_to(box) < reach_m * reach_m &&
        visibility::intersects(outlook.frustum, box))
      return outlook.tau_s;
  }
  return std::numeric_limits<float>::infinity();
}

// Finds the deadlines of all nodes.
void expect(const Camera& camera, const WorldFacts& facts, const Streaming& streaming,
            const VisibilityQuery& query, View& view) {
  view.outlooks.clear();
  for (const Camera::Prediction& prediction : camera.predictions) {
    const core::WorldPosition& to = prediction.pose.position;
    view.outlooks.push_back(
        {prediction.tau_s,
         glm::vec3(core::offset_m(to.block, camera.pose.position, facts.world.block_size_m()) +
                   to.local),
         frustum_of(prediction.pose, camera.projection)});
  }
  std::vector<float> reaches_m;
  for (std::size_t k = 0; k + 1 < view.levels.size(); ++k)
    reaches_m.push_back(
        static_cast<float>(streaming.distances[k + 1].merge_m + 2 * facts.levels[k].size_m));
  reaches_m.push_back(std::numeric_limits<float>::infinity());
  query.each<const QuadtreeNode>([&](auto, auto nodes) {
    for (const QuadtreeNode& node : nodes) {
      LevelView& level = view.levels[node.at.level];
      const std::size_t cell = streaming.grids[node.at.level].window_index(node.at.coord);
      level.deadlines[cell] =
          deadline_of(level.bounds[cell], reaches_m[node.at.level], view.outlooks);
    }
  });
}

void choose_cut(const SceneSettings& settings, const Camera& camera, const WorldFacts& facts,
                const Streaming& streaming, bool settling, View& view) {
  if (settling) view.cut.split.clear();  // no hysteresis
  visibility::select_cut(cut_input(facts.world, facts.levels, camera.pose.position,
                                   streaming.distances, settings.view_distance_m, view.roots),
                         view.cut);
}

// Finds the nodes of the cut that are ready, and those of them that are drawn in this tick unless a
// mesh is evicted or a hole is filled (find_ready() of the render system). A complete node is
// ready; where no ancestor is complete, so is bare ground.
void find_drawn(const Streaming& streaming, const VisibilityQuery& nodes, View& view) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  view.ready.assign(cut.size(), 0);
  std::vector<std::uint8_t>& complete = view.scratch;  // the node or an ancestor
  complete.assign(cut.size(), 0);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const bool above = cut[i].parent != visibility::kNoNode && complete[cut[i].parent] != 0;
    const ecs::Entity entity = streaming.grids[cut[i].node.level].entity_of(cut[i].node.coord);
    const MissingMeshes* lacking = nodes.get<MissingMeshes>(entity);
    const bool itself = lacking != nullptr && lacking->meshes == 0;
    const bool ground =
        lacking != nullptr && nodes.get<MeshDemand>(entity)->drawn_level != kNoLevel;
    complete[i] = above || itself ? 1 : 0;
    view.ready[i] = itself || (ground && !above) ? 1 : 0;
  }
  visibility::drawn_nodes(view.cut, view.ready, view.scratch, view.drawn);
}

// True if the occluder lines of a drawn node may hide others: none lies beyond the world, and none
// may lie above the camera, as in coarse ground drawn in place of lower fine ground.
bool hides_others(const WorldFacts& facts, const visibility::CutNode& node) {
  const bool around = node.corner_x_m <= 0 && node.corner_x_m + node.side_m >= 0 &&
                      node.corner_z_m <= 0 && node.corner_z_m + node.side_m >= 0;
  return !(around && !node.leaf) && !overhangs(facts.world, node.node);
}

// Finds the nodes of the cut in view: in the frustum, and not behind the drawn ground of other
// nodes. Front to back, so that each node is tested against the ground in front of it.
void find_hidden(const SceneSettings& settings, const Camera& camera, const WorldFacts& facts,
                 const Streaming& streaming, const VisibilityQuery& nodes, View& view) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  view.horizon.reset();
  view.in_view.assign(cut.size(), 0);
  const glm::dvec3& local = camera.pose.position.local;
  const bool hides =
      settings.occlusion &&
      local.y > models::ground_height_m(facts.world.terrain, camera.pose.position.block, local.x,
                                        local.z);
  std::size_t next = 0;  // of view.drawn
  for (std::uint32_t i = 0; i < cut.size();) {
    const visibility::NodeCoord& at = cut[i].node;
    const NodeGrid& grid = streaming.grids[at.level];
    const std::size_t cell = grid.window_index(at.coord);
    const core::Bounds& box = view.levels[at.level].bounds[cell];
    const bool in_frustum = view.levels[at.level].plp.in_view[cell] != 0;
    const bool hidden = in_frustum && view.horizon.hides(box);
    view.hidden += hidden ? 1 : 0;
    view.in_view[i] = in_frustum && !hidden ? 1 : 0;
    while (next < view.drawn.size() && view.drawn[next] < i)
      ++next;
    const bool drawn = next < view.drawn.size() && view.drawn[next] == i;
    if (hides && drawn && view.in_view[i] != 0 && hides_others(facts, cut[i])) {
      const auto& occluder = *nodes.get<GroundOccluder>(grid.entity_of(at.coord));
      add_lines(occluder, corner_of(at, camera, facts), cut[i].side_m, view.horizon);
    }
    i = view.in_view[i] != 0 ? i + 1 : cut[i].end;
  }
}

// Lists the nodes of the cut in view, and the siblings without which they cannot be drawn.
void list_chosen(const Streaming& streaming, const VisibilityQuery& nodes, View& view) {
  const std::vector<visibility::CutNode>& cut = view.cut.nodes;
  view.chosen.clear();
  std::vector<std::uint8_t> covered(cut.size(), 0);  // an ancestor or the node itself is complete
  std::size_t next = 0;                              // of view.drawn
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const visibility::CutNode& node = cut[i];
    const NodeGrid& grid = streaming.grids[node.node.level];
    const std::size_t cell = grid.window_index(node.node.coord);
    LevelView& level = view.levels[node.node.level];
    const bool root = node.parent == visibility::kNoNode;
    const bool covered_above = !root && covered[node.parent] != 0;
    const ecs::Entity entity = grid.entity_of(node.node.coord);
    const bool alive = nodes.alive(entity);
    covered[i] = covered_above || (alive && nodes.get<MissingMeshes>(entity)->meshes == 0) ? 1 : 0;
    while (next < view.drawn.size() && view.drawn[next] < i)
      ++next;
    // A node drawn in this tick is not covered, whatever is ready: its missing detail is visible.
    const bool drawn = next < view.drawn.size() && view.drawn[next] == i;
    if (view.in_view[i] == 0 && (root || view.in_view[node.parent] == 0)) {
      level.part[cell] = root || !node.leaf ? kAncestor : 0;
      continue;
    }
    if (!alive) continue;
    view.chosen.push_back({entity, node.node.level, node.leaf, node.fine, view.in_view[i] != 0,
                           covered_above && !drawn});
    level.part[cell] = view.in_view[i] != 0 ? kInView : kBeside;
  }
}

void write_visibility(const View& view, const Streaming& streaming, const VisibilityQuery& query) {
  query.each<const QuadtreeNode, Visibility>([&](auto, auto nodes, auto visibilities) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const visibility::NodeCoord& at = nodes[i].at;
      const LevelView& level = view.levels[at.level];
      const std::size_t cell = streaming.grids[at.level].window_index(at.coord);
      Visibility& visibility = visibilities[i];
      visibility.distance_m = std::sqrt(distance_squared_to(level.bounds[cell]));
      visibility.layer = static_cast<std::uint16_t>(
          std::min<std::uint32_t>(level.plp.key[cell] / visibility::kKeysPerLayer, UINT16_MAX));
      visibility.in_view = level.part[cell] == kInView ? 1 : 0;
      visibility.deadline_s = visibility.in_view != 0 ? 0.0F : level.deadlines[cell];
    }
  });
}

// True if a sibling of a node is expected in view: none of the four is drawn before all are
// complete.
bool sibling_is_expected(const NodeGrid& grid, const LevelView& level, core::BlockCoord coord) {
  for (const int i : {0, 1, 2, 3}) {
    const core::BlockCoord sibling{(coord.x & ~1) | (i & 1), (coord.z & ~1) | (i >> 1)};
    if (grid.contains(sibling) && std::isfinite(level.deadlines[grid.window_index(sibling)]))
      return true;
  }
  return false;
}

// Lists all other nodes, most important first.
void list_others(const Streaming& streaming, const VisibilityQuery& nodes, View& view) {
  view.expected.clear();
  view.around.clear();
  view.kept.clear();
  struct Expected {
    float deadline_s;
    ecs::Entity node;
  };
  std::vector<Expected> expected;
  for (std::size_t k = view.levels.size(); k-- > 0;) {
    const LevelView& level = view.levels[k];
    const NodeGrid& grid = streaming.grids[k];
    for (const auto* list : {&level.plp.visible, &level.plp.prefetch}) {
      for (const std::uint32_t cell : *list) {
        const std::uint8_t part = level.part[cell];
        if (part == kInView || part == kBeside) continue;
        const core::BlockCoord coord = grid.node_at(cell % grid.side(), cell / grid.side()).coord;
        const ecs::Entity entity = grid.entity_of(coord);
        if (!nodes.alive(entity)) continue;
        if (std::isfinite(level.deadlines[cell])) {
          expected.push_back({level.deadlines[cell], entity});
        } else if (part == kAncestor || sibling_is_expected(grid, level, coord)) {
          view.around.push_back(entity);
        } else {
          view.kept.push_back(entity);
        }
      }
    }
  }
  std::ranges::stable_sort(expected, {}, &Expected::deadline_s);
  for (const Expected& soon : expected)
    view.expected.push_back(soon.node);
}

}  // namespace

glm::vec3 corner_of(const visibility::NodeCoord& node, const Camera& camera,
                    const WorldFacts& facts) {
  return glm::vec3(core::offset_m(visibility::corner_block(node), camera.pose.position,
                                  facts.world.block_size_m()));
}

void visibility_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                       const Streaming& streaming, VisibilityQuery nodes, View& view) {
  const SceneSettings& settings = frame.settings;
  find_bounds(settings, camera, facts, streaming, nodes, view);
  view.frustum = frustum_of(camera.pose, camera.projection);
  for (const NodeGrid& grid : streaming.grids)
    project_layers(settings, grid, view.frustum, view.levels[grid.level()]);
  expect(camera, facts, streaming, nodes, view);
  choose_cut(settings, camera, facts, streaming, frame.rules.settle, view);
  find_drawn(streaming, nodes, view);
  find_hidden(settings, camera, facts, streaming, nodes, view);
  list_chosen(streaming, nodes, view);
  write_visibility(view, streaming, nodes);
  list_others(streaming, nodes, view);
}

}  // namespace psygen::scene
