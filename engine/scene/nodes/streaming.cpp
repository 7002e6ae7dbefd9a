#include "engine/scene/nodes/streaming.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {
namespace {

// The windows are listed again when distances have changed by this fraction.
constexpr double kRelistedChange = 0.05;
// Nodes that one tick creates at least, if as many are missing and time allows.
constexpr std::size_t kFewestCreated = 3;
// Cost of creating one entity on a virtual clock: about its time on a present-day core.
constexpr double kEntitySeconds = 0.5e-6;
// Nodes that wait for patches of a river network, of those that a tick looks at.
constexpr std::size_t kMaxWaiting = 64;
// Time for the heights of a block, where they cost more than its entities.
constexpr double kHeightsSeconds = 0.15e-3;
// More missing nodes mean that the camera has jumped: then a tick creates as many as time allows.
constexpr std::size_t kLeapt = 256;

// Distance from the middle of the camera's block to a node's square.
double distance_m(const Camera& camera, const WorldFacts& facts, const visibility::NodeCoord& at) {
  const double block_m = facts.world.block_size_m();
  const core::WorldPosition middle{camera.pose.position.block, {block_m / 2, 0, block_m / 2}};
  const glm::dvec3 corner = core::offset_m(visibility::corner_block(at), middle, block_m);
  const double size_m = facts.levels[at.level].size_m;
  const auto outside = [size_m](double low) { return std::max({low, -(low + size_m), 0.0}); };
  return std::hypot(outside(corner.x), outside(corner.z));
}

// The radius with which a window holds all nodes that may exist or be wanted.
std::uint32_t needed_radius(const WorldFacts& facts, const SceneSettings& settings,
                            const Streaming& streaming, const NodeGrid& grid) {
  return std::min(window_radius(facts.levels, settings, grid.level(), streaming.distances),
                  grid.max_radius());
}

bool windows_too_small(const WorldFacts& facts, const SceneSettings& settings,
                       const Streaming& streaming) {
  return std::ranges::any_of(streaming.grids, [&](const NodeGrid& grid) {
    return grid.radius() < needed_radius(facts, settings, streaming, grid);
  });
}

// Tells which nodes exist for a camera position.
class Window {
 public:
  Window(const SceneSettings& settings, const Camera& camera, const WorldFacts& facts,
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

void destroy_leaving_nodes(const Window& window, Streaming& streaming, const NodeWork& work) {
  std::vector<ecs::Entity> leaving;
  work.entities.each<const QuadtreeNode>([&](auto rows, auto nodes) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const visibility::NodeCoord& at = nodes[i].at;
      if (!streaming.grids[at.level].contains(at.coord) || !window.holds(at))
        leaving.push_back(rows[i]);
    }
  });
  streaming.counts.destroyed += static_cast<std::uint32_t>(leaving.size());
  destroy_nodes(leaving, work);
}

// Coarse nodes come first: they are few and stand in for all finer ones.
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

// Spreads the creation of new nodes over half of the ticks since the windows were last listed: at
// this speed they exist halfway to the next listing.
void spread_missing(const SceneSettings& settings, Streaming& streaming) {
  const bool leapt = streaming.missing.size() > kLeapt;
  const std::uint32_t ticks =
      leapt ? 1 : std::clamp(streaming.ticks_since_listed / 2, 1U, settings.streaming_ticks);
  streaming.ticks_since_listed = 0;
  streaming.per_tick = std::max(kFewestCreated, (streaming.missing.size() + ticks - 1) / ticks);
  streaming.spread_ticks = ticks;
}

}  // namespace

void streaming_system(StreamingContext context, Streaming& streaming, GroundPatches& patches,
                      NodeWork work) {
  const SceneSettings& settings = context.frame.settings;
  const Rules& rules = context.frame.rules;
  const WorldFacts& facts = context.facts;
  const Camera& camera = context.camera;
  split_distances(facts.levels, settings, camera.pixels_per_radian, context.quality.error_pixels,
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
    destroy_leaving_nodes(window, streaming, work);
    list_missing_nodes(window, camera, facts, work.entities, streaming);
    spread_missing(settings, streaming);
  }
  ++streaming.ticks_since_listed;
  // Lazy evaluation creates all nodes in every frame; so does filling the cache.
  const bool all = rules.wait || rules.settle;
  const std::size_t count = all ? streaming.missing.size() : streaming.per_tick;
  core::Stopwatch spent(settings.virtual_time);
  std::vector<world::Placement> scratch;
  std::size_t created = 0;
  // Nodes of the coarsest level stand in for all others. Without them there is a hole.
  const auto stands_in = [&](const visibility::NodeCoord& node) {
    return node.level + std::size_t{1} == facts.levels.size();
  };
  const auto may_wait = [&](const visibility::NodeCoord& node) {
    const bool late = !rules.wait && spent.seconds() * 1000.0 > settings.streaming_budget_ms;
    return !stands_in(node) && (created >= count || late);
  };
  // Only modelers make patches; a frame that waits for all meshes has none before it.
  const bool patient = rules.request && !rules.wait;
  patches.begin(facts);
  if (patient) patches.want_around(facts, context.daylight, camera.pose.position.block);
  std::vector<visibility::NodeCoord> waiting;  // the most important first
  const double heights_s = facts.world.has_costly_heights() ? kHeightsSeconds : 0;
  while (!streaming.missing.empty() && !may_wait(streaming.missing.back())) {
    const visibility::NodeCoord at = streaming.missing.back();
    streaming.missing.pop_back();
    if (patient && !stands_in(at) && !patches.ready(facts, context.daylight, at)) {
      waiting.push_back(at);
      if (waiting.size() == kMaxWaiting && !all) break;
      continue;
    }
    const std::size_t before = work.entities.size();
    streaming.grids[at.level].entity_of(at.coord) =
        create_node(settings, facts, context.daylight, at, scratch, work);
    spent.charge(kEntitySeconds * static_cast<double>(work.entities.size() - before) +
                 (at.level == 0 ? heights_s : 0));
    ++streaming.counts.created;
    ++created;
  }
  streaming.missing.insert(streaming.missing.end(), waiting.rbegin(), waiting.rend());
  if (streaming.missing.empty()) streaming.spread_ticks = 1;
}

NodeGrid::NodeGrid(std::uint8_t level, std::uint32_t radius)
    : level_(level),
      radius_(radius),
      max_radius_(radius),
      mask_(std::bit_ceil(2 * radius + 1) - 1),
      centre_{{}, level},
      cells_(std::size_t{mask_ + 1} * (mask_ + 1)) {}

// Position in the window along one axis; above side − 1 for nodes outside. Coordinates have 32 −
// level bits.
std::uint32_t NodeGrid::column_of(std::int32_t index, std::int32_t centre) const {
  const std::uint32_t column =
      static_cast<std::uint32_t>(index) - static_cast<std::uint32_t>(centre) + radius_;
  return column & (UINT32_MAX >> level_);
}

bool NodeGrid::contains(core::BlockCoord coord) const {
  return column_of(coord.x, centre_.coord.x) <= 2 * radius_ &&
         column_of(coord.z, centre_.coord.z) <= 2 * radius_;
}

visibility::NodeCoord NodeGrid::node_at(std::uint32_t column, std::uint32_t row) const {
  const auto radius = static_cast<std::int32_t>(radius_);
  return visibility::neighbour_of(centre_, static_cast<std::int32_t>(column) - radius,
                                  static_cast<std::int32_t>(row) - radius);
}

std::size_t NodeGrid::window_index(core::BlockCoord coord) const {
  return std::size_t{column_of(coord.z, centre_.coord.z)} * side() +
         column_of(coord.x, centre_.coord.x);
}

std::size_t NodeGrid::cell_of(core::BlockCoord coord) const {
  return std::size_t{static_cast<std::uint32_t>(coord.z) & mask_} * (mask_ + 1) +
         (static_cast<std::uint32_t>(coord.x) & mask_);
}

ecs::Entity& NodeGrid::entity_of(core::BlockCoord coord) {
  return cells_[cell_of(coord)];
}
ecs::Entity NodeGrid::entity_of(core::BlockCoord coord) const {
  return cells_[cell_of(coord)];
}

std::vector<NodeGrid> node_grids(const SceneSettings& settings, const WorldFacts& facts) {
  std::vector<NodeGrid> grids;
  for (std::size_t k = 0; k < facts.levels.size(); ++k)
    grids.emplace_back(static_cast<std::uint8_t>(k),
                       largest_radius(facts.world, facts.levels, settings, k));
  return grids;
}

}  // namespace psygen::scene
