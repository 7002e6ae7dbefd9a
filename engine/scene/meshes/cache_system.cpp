// Chooses the LOD of every mesh entity (mesh_choice.hpp), takes ready meshes from the cache, ranks
// drawn ones, and plans the synthesis of missing ones. Visits nodes that the frame depends on in
// every tick, front to back; those around the camera every 8th.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/meshes/mesh_choice.hpp"
#include "engine/scene/meshes/scene_meshes.hpp"
#include "engine/scene/meshes/tree_impostors.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

using synthesis::RankGroup;

// Nodes out of view are revisited every 8th tick, and their models may have twice the error.
constexpr std::size_t kAroundTurns = 8;
constexpr float kAroundErrorFactor = 2.0F;
// The cache gets the rank of a drawn mesh when its group changes, otherwise every 32nd tick, or in
// every tick while little memory is free: only then do ranks matter.
constexpr std::uint32_t kRankTurns = 32;
// Minimum number of meshes out of view that a tick may reserve while new nodes are created.
constexpr std::uint32_t kFewestHidden = 48;
// Time for which frames may be too coarse before the main thread helps: modelers get only the
// processor time that other threads leave, which may be none.
constexpr double kCoarsePatienceSeconds = 0.03;
// Predicted synthesis time of the main thread in a tick of a draft: models on blocks in view that
// still show the replaced world, nearest first. A user who tries values waits for these.
constexpr double kDraftSeconds = 0.008;
// A mesh requested in one tick is drawn two ticks later: 1/15 s at 30 frames/s.
constexpr float kLandingSeconds = 1.0F / 15;

// The tick's values for all mesh entities.
struct CacheTick {
  ChoiceRules choice;
  std::uint32_t tick = 0;
  float near_m = 0;      // of the projection
  bool request = true;   // missing meshes are synthesised
  bool roomy = false;    // enough memory is free that only unwanted meshes are evicted
  bool shadows = false;  // models out of view may cast shadows into the frame
  double draft_s = 0;    // rest of kDraftSeconds
  glm::vec3 soon{0.0F};  // camera movement in kLandingSeconds; 0: no look-ahead
};

// A row of the columns of a mesh entity.
struct MeshEntity {
  ecs::Entity entity;
  const MeshPlacement& placed;
  const LodErrors& detail;
  const MeshSource& source;
  const Mesh& mesh;
  MeshDemand& demand;
};

bool is_roomy(const synthesis::CacheStats& stats) {
  constexpr double kRoomyShare = 0.8;
  return static_cast<double>(stats.bytes - std::min(stats.bytes, stats.unwanted_bytes)) <
         kRoomyShare * static_cast<double>(stats.limit_bytes);
}

// The memory of meshes in view as a fraction of the limit. Other meshes do not count, because they
// can be evicted.
double seen_share(const synthesis::CacheStats& stats) {
  return static_cast<double>(stats.visible_bytes) / static_cast<double>(stats.limit_bytes);
}

ChoiceRules choice_rules(const StreamingContext& context, const MemoryPressure& pressure) {
  const Rules& rules = context.frame.rules;
  ChoiceRules choice = choice_of_picture(context);
  choice.node_levels = context.facts.levels.size();
  choice.real_s = context.frame.clock.real_s;
  choice.settle = rules.settle;
  choice.ask_early = !rules.settle && !rules.wait;
  choice.coarse_first = rules.coarse_first;
  choice.short_of_memory = context.quality.coarsening > 1;
  choice.awaits_memory = pressure.waiting > 0;
  choice.draft = context.quality.draft && !rules.settle;
  return choice;
}

// The bounds of the mesh that is or was drawn, else the conservative bounds, relative to the base
// point. Keeps the bounds of an evicted mesh: otherwise a mesh out of view would become a hole
// after its eviction.
core::Bounds box_of(const MeshEntity& row, bool shadows) {
  if (row.mesh.tight != core::Bounds{} && !shadows) return row.mesh.tight;
  return core::Bounds::around(row.placed.box_centre, row.placed.box_half_extent);
}

void note_in_view(const CacheTick& tick, bool leaf, MeshDemand& demand, MeshCounts& counts) {
  const bool entered = demand.in_view_tick + 1 != tick.tick;
  if (entered) demand.entered_tick = tick.tick;
  demand.in_view_tick = tick.tick;
  if (demand.wanted_level == kNoLevel || !leaf) return;
  if (demand.drawn_level == kNoLevel) {
    if (demand.seen_s < 0) demand.seen_s = static_cast<float>(tick.choice.real_s);
  } else if (entered) {
    counts.time_to_visible_ms.push_back(0.0F);
  }
}

// Ranks the drawn mesh in the cache, if that is due (kRankTurns).
void keep(const CacheTick& tick, const NodeView& node, const MeshEntity& row, RankGroup group,
          float distance_m, synthesis::MeshSupply& supply) {
  const bool turn =
      node.around || (row.entity.index + tick.tick) % (tick.roomy ? kRankTurns : 1) == 0;
  std::uint8_t& ranked = row.demand.ranked;
  if (ranked == static_cast<std::uint8_t>(group) && !turn) return;
  ranked = static_cast<std::uint8_t>(group);
  supply.rank(row.mesh.handle, rank_on(node, group, distance_m));
}

// Takes the chosen mesh from the cache, or requests it.
void request(CacheTick& tick, const NodeView& node, const MeshEntity& row, const MeshChoice& choice,
             float distance_m, const CacheWork& work) {
  const MeshSource& source = row.source;
  MeshDemand& demand = row.demand;
  if (node.kept && !demand.stale) return;
  const synthesis::MeshKey key = key_of(row.placed, row.detail, row.source, choice.request);
  const bool first_time = demand.requested_level != choice.request;
  demand.requested_level = choice.request;
  const synthesis::MeshHandle handle =
      first_time ? work.supply.look_up(key) : work.supply.find(key);
  const synthesis::MeshRecord* record = work.supply.get(handle);
  if (record != nullptr && record->state == synthesis::MeshState::kReady) {
    work.meshes.found.push_back({row.entity, handle});
    // The entity that requested it may be dead; the cache reports evictions to the owner.
    const RankGroup landed =
        synthesis::is_visible(choice.requested) ? RankGroup::kDrawn : choice.requested;
    work.supply.adopt(handle, owner_of(row.entity), rank_on(node, landed, distance_m));
    return;
  }
  if (record != nullptr && record->state == synthesis::MeshState::kFailed) {
    demand.failed_levels |= static_cast<std::uint8_t>(1u << choice.request);
    return;
  }
  if (!tick.request) return;
  // New light after a distant edit waits for all other meshes.
  const RankGroup group = demand.stale_light ? RankGroup::kPrefetch : choice.requested;
  synthesis::Want want{key,
                       &source.parameters,
                       owner_of(row.entity),
                       rank_on(node, group, distance_m),
                       node.visibility.deadline_s,
                       choice.at_once && !demand.stale_light};
  const bool awaited =
      demand.stale && !demand.stale_light && node.level == 0 && demand.in_view_tick == tick.tick;
  if (awaited && tick.draft_s > 0) {
    tick.draft_s -= work.supply.predict(want);
    want.at_once = true;
  }
  work.supply.want(want);
}

// An individual model that has become large enough to be drawn counts as missing from this many
// times that size on. Below it, the model is requested, but its node need not be replaced by a
// coarser one.
constexpr float kLackedFrom = 1.25F;

bool is_early(const ChoiceRules& rules, const NodeView& node, const MeshDemand& demand,
              float size_pixels) {
  return rules.ask_early && node.level == 0 && demand.drawn_level == kNoLevel &&
         size_pixels < kLackedFrom * rules.min_size_pixels;
}

// Requests a mesh before it is missing. The model counts as too small until it is ready.
void ask_early(CacheTick& tick, NodeView node, const MeshEntity& row, bool in_view,
               float distance_m, const CacheWork& work) {
  node.covered = true;
  const MeshChoice choice =
      choose_mesh(tick.choice, node, row.detail, row.demand, {.in_view = in_view});
  if (choice.request != kNoLevel) request(tick, node, row, choice, distance_m, work);
  row.demand.wanted_level = kNoLevel;
}

// Finds the wanted LOD of a mesh, and the size of a model in pixels; infinite for ground.
float want_level(const CacheTick& tick, const NodeView& node, const MeshEntity& row, bool is_ground,
                 float distance_m) {
  MeshDemand& demand = row.demand;
  if (is_ground) {
    demand.wanted_level = ground_level(node, row.detail, demand.drawn_level);
    return std::numeric_limits<float>::infinity();
  }
  const float pixels =
      size_pixels(row.placed, row.detail, distance_m, tick.choice.pixels_per_radian, tick.near_m);
  demand.wanted_level =
      model_level(tick.choice, node, row.detail, pixels, distance_m, demand.drawn_level);
  return pixels;
}

// Looks ahead for a model in view that lacks nothing: requests the finer LOD that it will soon
// need, and keeps it. Missing meshes go first.
MeshChoice look_ahead(const CacheTick& tick, const NodeView& node, const MeshEntity& row,
                      const glm::vec3& foot, const MeshChoice& here) {
  const MeshDemand& demand = row.demand;
  const bool lacks = demand.stale || demand.drawn_level > demand.wanted_level;  // or has no mesh
  const float ahead = glm::dot(foot, tick.soon);
  if (node.level > 0 || lacks || demand.wanted_level == 0 || ahead <= 0) return here;
  // Distance from the nearest point of the camera's path.
  const glm::vec3 moved = tick.soon * std::min(ahead / glm::dot(tick.soon, tick.soon), 1.0F);
  const float distance_m = distance_to(row.placed, foot - moved, tick.near_m);
  const float pixels =
      size_pixels(row.placed, row.detail, distance_m, tick.choice.pixels_per_radian, tick.near_m);
  MeshDemand soon = demand;
  soon.wanted_level =
      model_level(tick.choice, node, row.detail, pixels, distance_m, demand.drawn_level);
  if (soon.wanted_level >= demand.wanted_level) return here;
  MeshChoice choice = choose_mesh(tick.choice, node, row.detail, soon, {});
  if (choice.request < demand.drawn_level) choice.requested = RankGroup::kPrefetch;
  return choice;
}

// Replaces the LOD that a model would show by the LOD to keep ready out of view.
void want_out_of_view(const CacheTick& tick, const View& view, const NodeView& node,
                      const MeshEntity& row, const glm::vec3& foot,
                      const synthesis::MeshSupply& supply) {
  MeshDemand& demand = row.demand;
  const PredictedView* const outlook = std::isfinite(node.visibility.deadline_s)
                                           ? first_to_see(box_of(row, tick.shadows), foot, view)
                                           : nullptr;
  if (outlook != nullptr && node.level == 0) {
    const float distance_m = distance_to(row.placed, foot - outlook->moved, tick.near_m);
    want_level(tick, node, row, /*is_ground=*/false, distance_m);
  }
  const std::uint8_t shown = demand.wanted_level;
  demand.wanted_level = level_out_of_view(row.detail, shown, outlook != nullptr,
                                          tick.choice.settle ? kNoLevel : demand.drawn_level);
  const bool asks = !tick.choice.settle && demand.wanted_level != demand.drawn_level &&
                    demand.wanted_level != shown;
  if (asks &&
      supply.ready(supply.find(key_of(row.placed, row.detail, row.source, shown))) != nullptr)
    demand.wanted_level = shown;
}

// Considers the ground of a node, or a model on it. Returns false if a mesh should be drawn but
// none is ready.
bool consider(CacheTick& tick, const View& view, const NodeView& node, const MeshEntity& row,
              bool is_ground, const CacheWork& work) {
  const MeshPlacement& placed = row.placed;
  MeshDemand& demand = row.demand;
  const glm::vec3 foot = node.corner + placed.position;
  const bool near = is_ground || node.level > 0;  // as near as the node itself
  const float distance_m =
      near ? node.visibility.distance_m : distance_to(placed, foot, tick.near_m);
  const bool in_view =
      node.in_view && (near || mesh_may_be_visible(box_of(row, tick.shadows), foot, view));
  const float pixels = want_level(tick, node, row, is_ground, distance_m);
  if (!in_view && !is_ground && !tick.shadows && tick.choice.levels_of_detail)
    want_out_of_view(tick, view, node, row, foot, work.supply);
  if (demand.wanted_level != kNoLevel && is_early(tick.choice, node, demand, pixels)) {
    ask_early(tick, node, row, in_view, distance_m, work);
    return true;
  }
  if (in_view) {
    note_in_view(tick, node.leaf, demand, work.meshes.counts);
  } else {
    demand.seen_s = -1;
  }
  const bool drawn = demand.drawn_level != kNoLevel;
  if (demand.wanted_level == kNoLevel) {
    // Too small to be drawn: evicted first.
    if (drawn) keep(tick, node, row, RankGroup::kUnwanted, distance_m, work.supply);
    return true;
  }
  // Only for holes, because look-ups take time.
  const bool cached = tick.choice.coarse_first && is_hole(node, demand, in_view) &&
                      work.supply.ready(work.supply.find(key_of(row.placed, row.detail, row.source,
                                                                demand.wanted_level))) != nullptr;
  MeshChoice choice =
      choose_mesh(tick.choice, node, row.detail, demand, {in_view, is_ground, cached});
  if (in_view && !is_ground) choice = look_ahead(tick, node, row, foot, choice);
  if (drawn) keep(tick, node, row, choice.drawn, distance_m, work.supply);
  if (choice.there) demand.requested_level = kNoLevel;
  if (choice.request != kNoLevel) request(tick, node, row, choice, distance_m, work);
  const unsigned all_levels = (1U << row.detail.level_count) - 1;
  return drawn || demand.failed_levels == all_levels || demand.added;
}

// Calls visit(row) for these mesh entities. Returns how often it was false.
template <class Visit>
std::uint32_t count_false(const CacheQuery& entities, std::span<const ecs::Entity> which,
                          const Visit& visit) {
  std::uint32_t count = 0;
  entities.each_of<const MeshPlacement, const LodErrors, const MeshSource, const Mesh, MeshDemand>(
      which, [&](auto rows, auto placed, auto detail, auto source, auto mesh, auto demand) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const MeshEntity row{rows[i], placed[i], detail[i], source[i], mesh[i], demand[i]};
          count += visit(row) ? 0 : 1;
        }
      });
  return count;
}

// Calls visit(node, row, is_ground) for the meshes of every node of `nodes`, in this order, and
// records how many lack a mesh. `common`: the values that the nodes share.
template <class Visit>
void visit_nodes(const CacheQuery& entities, std::span<const ecs::Entity> nodes,
                 const core::WorldPosition& eye, double block_size_m, NodeView common,
                 const Visit& visit) {
  entities.each_of<const QuadtreeNode, const ecs::Children, const Visibility, MissingMeshes>(
      nodes, [&](auto rows, auto node, auto models, auto visibility, auto lacking) {
        NodeView view = common;
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const core::BlockCoord corner = visibility::corner_block(node[i].at);
          view.corner = glm::vec3(core::offset_m(corner, eye, block_size_m));
          view.visibility = visibility[i];
          view.level = node[i].at.level;
          const auto ground = [&](const MeshEntity& row) { return visit(view, row, true); };
          const auto model = [&](const MeshEntity& row) { return visit(view, row, false); };
          lacking[i].meshes = count_false(entities, rows.subspan(i, 1), ground) +
                              count_false(entities, entities.children(models[i]), model);
        }
      });
}

// Every n-th node, starting with another one in each tick.
std::vector<ecs::Entity> every_nth(std::span<const ecs::Entity> nodes, std::size_t n,
                                   std::uint32_t tick) {
  std::vector<ecs::Entity> chosen;
  for (std::size_t i = tick % n; i < nodes.size(); i += n)
    chosen.push_back(nodes[i]);
  return chosen;
}

// Lazy evaluation keeps nothing: frees the meshes of the last frame.
void forget_last_frame(const CacheQuery& entities, synthesis::MeshSupply& supply) {
  entities.each<MeshDemand, const Mesh>([&supply](auto, auto demands, auto meshes) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      supply.forget(meshes[i].handle);
      demands[i].drawn_level = kNoLevel;
    }
  });
}

// Entities whose mesh was evicted draw nothing until they get another.
void drop_evicted(const CacheQuery& entities, const CacheWork& work) {
  for (const synthesis::Eviction& eviction : work.supply.take_evictions()) {
    const ecs::Entity owner = entity_of(eviction.owner);
    work.evicted.emit({owner, eviction.key});
    const Mesh* mesh = entities.get<Mesh>(owner);
    if (mesh != nullptr && mesh->handle == eviction.handle) {
      entities.get<MeshDemand>(owner)->drawn_level = kNoLevel;
    }
    Fading* fading = entities.get<Fading>(owner);
    if (fading != nullptr && fading->old_mesh == eviction.handle) fading->old_mesh = {};
  }
}

synthesis::PlanLimits plan_limits(const StreamingContext& context, const Streaming& streaming,
                                  const MemoryPressure& pressure) {
  const SceneSettings& settings = context.frame.settings;
  const Rules& rules = context.frame.rules;
  synthesis::PlanLimits limits;
  if (rules.wait) {
    limits.seconds_ahead = std::numeric_limits<double>::infinity();
    limits.max_requests = UINT32_MAX;
  } else {
    limits.seconds_ahead = settings.plan_seconds_ahead;
    limits.max_requests = settings.plan_max_requests;
    limits.seconds_here = settings.main_thread_budget_ms / 1000.0;
    if (!rules.settle) {
      limits.max_new = settings.plan_max_new;
      limits.max_new_hidden =
          std::max(settings.plan_max_new / streaming.spread_ticks, kFewestHidden);
    }
  }
  const double awaited_s = context.frame.clock.real_s - context.quality.awaiting_since_s;
  if (context.quality.draft || (pressure.waiting == 0 && awaited_s > kCoarsePatienceSeconds))
    limits.here_up_to = RankGroup::kVisibleCoarse;
  return limits;
}

// The tick's values for all mesh entities.
CacheTick cache_tick(const StreamingContext& context, const View& view, const CacheWork& work) {
  const Rules& rules = context.frame.rules;
  const bool draft = context.quality.draft;
  CacheTick tick;
  tick.choice = choice_rules(context, work.pressure);
  tick.tick = context.frame.clock.tick;
  tick.near_m = context.camera.projection.near_m;
  tick.request = rules.request;
  tick.roomy = is_roomy(work.supply.stats());
  tick.shadows = context.facts.shadows;
  tick.draft_s = draft && !rules.settle ? kDraftSeconds : 0;
  if (rules.look_ahead && !rules.settle && !draft && !view.outlooks.empty())
    tick.soon = view.outlooks.front().moved * (kLandingSeconds / view.outlooks.front().tau_s);
  return tick;
}

// Looks at the meshes of all nodes that matter to this tick.
void visit_all(const StreamingContext& context, const View& view, const CacheQuery& entities,
               const CacheWork& work) {
  const Rules& rules = context.frame.rules;
  CacheTick tick = cache_tick(context, view, work);
  const auto visit = [&](std::span<const ecs::Entity> nodes, const NodeView& common) {
    visit_nodes(entities, nodes, context.camera.pose.position, context.facts.world.block_size_m(),
                common, [&](const NodeView& node, const MeshEntity& row, bool is_ground) {
                  return consider(tick, view, node, row, is_ground, work);
                });
  };
  for (const ChosenNode& node : view.chosen) {
    if (rules.wait && !(node.leaf && node.in_view)) continue;
    visit(std::span(&node.entity, 1), {.wanted = true,
                                       .in_view = node.in_view,
                                       .covered = node.covered,
                                       .leaf = node.leaf,
                                       .fine = node.fine});
  }
  if (!rules.look_ahead) return;
  visit(view.expected, NodeView{});
  const std::vector<ecs::Entity> ready = every_nth(view.around, kAroundTurns, tick.tick);
  visit(ready, NodeView{.error_factor = kAroundErrorFactor, .around = true});
  const std::vector<ecs::Entity> kept = every_nth(view.kept, kAroundTurns, tick.tick);
  visit(kept, NodeView{.error_factor = kAroundErrorFactor, .around = true, .kept = true});
}

}  // namespace

void cache_system(StreamingContext context, VisibleNodes nodes, const Assets& assets,
                  CacheQuery entities, CacheWork work) {
  auto& [supply, meshes, patches, pressure, evicted, places_ready] = work;
  const Rules& rules = context.frame.rules;
  if (!rules.keep) forget_last_frame(entities, supply);
  supply.begin_wants();
  assets.want_all(supply);
  patches.want_all(context.facts, supply);
  // A draft shows the impostors of the replaced world.
  if (!context.quality.draft) want_pictures(context.facts, meshes, supply);
  meshes.found.clear();
  // The frame's wants come later and replace those of places.
  if (rules.request && !rules.settle)
    update_requested_places(context, meshes.places, supply, places_ready);
  visit_all(context, nodes.view, entities, work);
  const synthesis::PlanReport report =
      supply.plan(plan_limits(context, nodes.streaming, pressure), context.frame.settings.policy);
  drop_evicted(entities, work);
  meshes.counts.requests = static_cast<std::uint32_t>(supply.wants().size());
  meshes.counts.refused = report.refused;
  meshes.counts.refused_visible = report.refused_visible;
  pressure.refused_visible = report.refused_visible;
  pressure.waiting = report.waiting;
  pressure.seen_share = seen_share(supply.stats());
  pressure.at_s = context.frame.clock.real_s;
}

}  // namespace psygen::scene
