// Keeps one entity per node of the quadtree that may be drawn soon, and one per model on it:
// created and destroyed in batches, coarse nodes before fine ones and nearest first, within a time
// budget per tick.
#include <algorithm>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// The window is looked at again when distances have changed by this share.
constexpr double kRelistedChange = 0.05;
// Created in one tick at least, if as many are missing and time allows.
constexpr std::size_t kFewestCreated = 3;
// On a virtual clock: of an entity that is created, about what it takes on a core of today.
constexpr double kEntitySeconds = 0.5e-6;
// If more than this are missing the camera has leapt: as many as time allows.
constexpr std::size_t kLeapt = 256;

// How far the middle of the camera's block is from a node's square.
double distance_m(const Camera& camera, const WorldFacts& facts, const visibility::NodeCoord& at) {
  const double block_m = facts.world.block_size_m();
  const core::WorldPosition middle{camera.pose.position.block, {block_m / 2, 0, block_m / 2}};
  const glm::dvec3 corner = core::offset_m(visibility::corner_block(at), middle, block_m);
  const double size_m = facts.levels[at.level].size_m;
  const auto outside = [size_m](double low) { return std::max({low, -(low + size_m), 0.0}); };
  return std::hypot(outside(corner.x), outside(corner.z));
}

// How far windows must reach so that all nodes that may exist, or be wanted, lie in them.
std::uint32_t needed_radius(const WorldFacts& facts, const Settings& settings,
                            const Streaming& streaming, const NodeGrid& grid) {
  return std::min(window_radius(facts.levels, settings, grid.level(), streaming.distances),
                  grid.max_radius());
}

bool windows_too_small(const WorldFacts& facts, const Settings& settings,
                       const Streaming& streaming) {
  return std::ranges::any_of(streaming.grids, [&](const NodeGrid& grid) {
    return grid.radius() < needed_radius(facts, settings, streaming, grid);
  });
}

// Which nodes exist at the camera's place.
class Window {
 public:
  Window(const Settings& settings, const Camera& camera, const WorldFacts& facts,
         const Streaming& streaming)
      : camera_(camera), facts_(facts) {
    for (std::size_t k = 0; k < facts.levels.size(); ++k)
      reach_m_.push_back(existing_distance_m(facts.levels, settings, k, streaming.distances));
  }

  bool holds(const visibility::NodeCoord& at) const {
    if (!contains(facts_.world, at)) return false;
    const bool top = at.level + 1U == facts_.levels.size();
    return distance_m(camera_, facts_, top ? at : visibility::parent_of(at)) < reach_m_[at.level];
  }

 private:
  const Camera& camera_;
  const WorldFacts& facts_;
  std::vector<double> reach_m_;
};

void destroy_leaving_nodes(const Window& window, const Streaming& streaming, ecs::World& entities,
                           synthesis::MeshSupply& supply, ecs::EventQueue<ModelRemoved>& removed,
                           Counters& counters) {
  std::vector<ecs::Entity> leaving;
  entities.each<const Node>([&](std::span<const ecs::Entity> rows, std::span<const Node> nodes) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const visibility::NodeCoord& at = nodes[i].at;
      if (!streaming.grids[at.level].contains(at.coord) || !window.holds(at))
        leaving.push_back(rows[i]);
    }
  });
  counters.nodes_destroyed += static_cast<std::uint32_t>(leaving.size());
  destroy_nodes(leaving, supply, entities, removed);
}

// Coarse nodes are few and stand for all finer ones: they come first.
void list_missing_nodes(const Window& window, const Camera& camera, const WorldFacts& facts,
                        const ecs::World& entities, Streaming& streaming) {
  streaming.missing.clear();
  struct Missing {
    double distance_m;
    visibility::NodeCoord at;
  };
  std::vector<Missing> of_level;
  for (const NodeGrid& grid : streaming.grids) {
    of_level.clear();
    for (std::uint32_t row = 0; row < grid.side(); ++row) {
      for (std::uint32_t column = 0; column < grid.side(); ++column) {
        const visibility::NodeCoord at = grid.node_at(column, row);
        if (!entities.alive(grid.entity_of(at.coord)) && window.holds(at))
          of_level.push_back({distance_m(camera, facts, at), at});
      }
    }
    std::ranges::sort(of_level, std::greater{}, &Missing::distance_m);
    for (const Missing& missing : of_level)
      streaming.missing.push_back(missing.at);
  }
}

// Spreads the creation of new nodes over half of the ticks since the window was last listed: at
// this speed they exist halfway to the next listing.
void spread_missing(const Settings& settings, Streaming& streaming) {
  const bool leapt = streaming.missing.size() > kLeapt;
  const std::uint32_t ticks =
      leapt ? 1 : std::clamp(streaming.ticks_since_listed / 2, 1U, settings.streaming_ticks);
  streaming.ticks_since_listed = 0;
  streaming.per_tick = std::max(kFewestCreated, (streaming.missing.size() + ticks - 1) / ticks);
  streaming.spread_ticks = ticks;
}

}  // namespace

void streaming_system(const Settings& settings, const Rules& rules, const Camera& camera,
                      const Quality& quality, const WorldFacts& facts, const Daylight& daylight,
                      Streaming& streaming, ecs::World& entities, synthesis::MeshSupply& meshes,
                      ecs::EventQueue<ModelCreated>& created_models,
                      ecs::EventQueue<ModelRemoved>& removed_models, Counters& counters) {
  split_distances(facts.levels, settings, camera.pixels_per_radian, quality.error_pixels,
                  streaming.distances);
  const core::BlockCoord place = camera.pose.position.block;
  const double reach = streaming.distances.back().split_m;
  if (place != streaming.listed_at ||
      std::abs(reach - streaming.listed_split_m) > kRelistedChange * reach ||
      windows_too_small(facts, settings, streaming)) {
    for (NodeGrid& grid : streaming.grids) {
      grid.set_centre(nearest_block(facts.world, place));
      grid.set_radius(needed_radius(facts, settings, streaming, grid));
    }
    streaming.listed_split_m = reach;
    streaming.listed_at = place;
    const Window window(settings, camera, facts, streaming);
    destroy_leaving_nodes(window, streaming, entities, meshes, removed_models, counters);
    list_missing_nodes(window, camera, facts, entities, streaming);
    spread_missing(settings, streaming);
  }
  ++streaming.ticks_since_listed;
  // All of it for lazy evaluation, in every frame, and before the first frame.
  const bool all = rules.wait || rules.settle;
  const std::size_t count = all ? streaming.missing.size() : streaming.per_tick;
  core::Stopwatch spent(settings.virtual_time);
  std::vector<world::Placement> scratch;
  std::size_t created = 0;
  // Nodes of the coarsest level stand for all others. Without them there is a hole.
  const auto may_wait = [&](const visibility::NodeCoord& node) {
    const bool late = !rules.wait && spent.seconds() * 1000.0 > settings.streaming_budget_ms;
    return node.level + std::size_t{1} < facts.levels.size() && (created >= count || late);
  };
  while (!streaming.missing.empty() && !may_wait(streaming.missing.back())) {
    const std::size_t before = entities.size();
    const visibility::NodeCoord& at = streaming.missing.back();
    streaming.grids[at.level].entity_of(at.coord) =
        create_node(settings, facts, daylight, at, scratch, entities, created_models);
    spent.charge(kEntitySeconds * static_cast<double>(entities.size() - before));
    streaming.missing.pop_back();
    ++counters.nodes_created;
    ++created;
  }
  if (streaming.missing.empty()) streaming.spread_ticks = 1;
}

}  // namespace psygen::scene
