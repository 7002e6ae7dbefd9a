// Decides what every mesh entity should show (quality/mesh_choice.hpp), takes from the cache what
// it has, ranks what it keeps, and plans what is missing. Nodes that the picture depends on are
// visited in every tick, front to back; those around the camera every 8th.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/scene/draws/seen.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/quality/mesh_choice.hpp"
#include "engine/scene/systems.hpp"
#include "engine/scene/tree_pictures.hpp"

namespace psygen::scene {
namespace {

using synthesis::RankGroup;

// Nodes out of view are revisited every 8th tick, and their models may have twice the error.
constexpr std::size_t kAroundTurns = 8;
constexpr float kAroundErrorFactor = 2.0F;
// The cache is told the rank of what is drawn when its group changes, otherwise every 32nd tick, or
// in every tick where little room is left: nothing else makes ranks matter.
constexpr std::uint32_t kRankTurns = 32;
// While new nodes come, meshes out of view that may be reserved in a tick at least.
constexpr std::uint32_t kFewestHidden = 48;
// How long pictures may be too coarse before the main thread helps: modelers get only what others
// leave of the processors, and that can be nothing.
constexpr double kCoarsePatienceSeconds = 0.03;
// What the main thread makes in a tick of a draft, predicted: models on blocks in view that are
// still those of a world before, nearest first. Who tries out a value waits for these.
constexpr double kDraftSeconds = 0.008;
// A mesh asked for in one tick is drawn two ticks later: 1/15 s at 30 frames/s.
constexpr float kLandingSeconds = 1.0F / 15;

// What all mesh entities are judged by in this tick.
struct CacheTick {
  ChoiceRules choice;
  std::uint32_t tick = 0;
  float near_m = 0;      // of the projection
  bool request = true;   // what is missing is synthesised
  bool roomy = false;    // ranks do not matter: only unwanted meshes will be evicted
  bool shadows = false;  // what is out of view may cast some into the picture
  double draft_s = 0;    // what is left of kDraftSeconds
  glm::vec3 soon{0.0F};  // how far the camera moves in kLandingSeconds; 0: nothing is asked ahead
};

// A row of the columns of a mesh entity.
struct MeshEntity {
  ecs::Entity entity;
  const Placed& placed;
  const Detail& detail;
  const Source& source;
  const Mesh& mesh;
  Demand& demand;
};

bool is_roomy(const synthesis::CacheStats& stats) {
  constexpr double kRoomyShare = 0.8;
  return static_cast<double>(stats.bytes - std::min(stats.bytes, stats.unwanted_bytes)) <
         kRoomyShare * static_cast<double>(stats.limit_bytes);
}

// The bytes of what is seen as a share of the limit. Meshes that are only kept do not count: they
// give way.
double seen_share(const synthesis::CacheStats& stats) {
  return static_cast<double>(stats.visible_bytes) / static_cast<double>(stats.limit_bytes);
}

ChoiceRules choice_rules(const Settings& settings, const Rules& rules, const Clock& clock,
                         const Camera& camera, const Quality& quality, const WorldFacts& facts,
                         const Pressure& pressure) {
  ChoiceRules choice = choice_of_picture(settings, camera, quality, facts);
  choice.node_levels = facts.levels.size();
  choice.real_s = clock.real_s;
  choice.settle = rules.settle;
  choice.ask_early = !rules.settle && !rules.wait;
  choice.coarse_first = rules.coarse_first;
  choice.short_of_memory = quality.coarsening > 1;
  choice.awaits_memory = pressure.waiting > 0;
  choice.draft = quality.draft && !rules.settle;
  return choice;
}

// The box around the mesh that is or was drawn, else around all that is possible; from the foot.
// The box of an evicted mesh is kept: otherwise a mesh out of view would be a hole after its
// eviction.
core::Bounds box_of(const MeshEntity& row, bool shadows) {
  if (row.mesh.tight != core::Bounds{} && !shadows) return row.mesh.tight;
  return core::Bounds::around(row.placed.box_centre, row.placed.box_half_extent);
}

void note_in_view(const CacheTick& tick, bool leaf, Demand& demand, Counters& counters) {
  const bool entered = demand.in_view_tick + 1 != tick.tick;
  if (entered) demand.entered_tick = tick.tick;
  demand.in_view_tick = tick.tick;
  if (demand.wanted_level == kNoLevel || !leaf) return;
  if (demand.drawn_level == kNoLevel) {
    if (demand.seen_s < 0) demand.seen_s = static_cast<float>(tick.choice.real_s);
  } else if (entered) {
    counters.time_to_visible_ms.push_back(0.0F);
  }
}

// Tells the cache how important the drawn mesh is, if it is due (kRankTurns).
void keep(const CacheTick& tick, const NodeView& node, const MeshEntity& row, RankGroup group,
          float distance_m, synthesis::MeshSupply& meshes) {
  const bool turn =
      node.around || (row.entity.index + tick.tick) % (tick.roomy ? kRankTurns : 1) == 0;
  std::uint8_t& ranked = row.demand.ranked;
  if (ranked == static_cast<std::uint8_t>(group) && !turn) return;
  ranked = static_cast<std::uint8_t>(group);
  meshes.rank(row.mesh.handle, rank_on(node, group, distance_m));
}

// Takes the chosen mesh from the cache, or asks for it.
void request(CacheTick& tick, const NodeView& node, const MeshEntity& row, const MeshChoice& choice,
             float distance_m, synthesis::MeshSupply& meshes, Found& found) {
  const Source& source = row.source;
  Demand& demand = row.demand;
  if (node.kept && !demand.stale) return;
  const synthesis::MeshKey key = key_of(row.placed, row.detail, row.source, choice.request);
  const bool first_time = demand.requested_level != choice.request;
  demand.requested_level = choice.request;
  const synthesis::MeshHandle handle = first_time ? meshes.look_up(key) : meshes.find(key);
  const synthesis::MeshRecord* record = meshes.get(handle);
  if (record != nullptr && record->state == synthesis::MeshState::kReady) {
    found.meshes.push_back({row.entity, handle});
    // The entity that asked for it may have been destroyed; evictions are reported to the owner.
    const RankGroup landed =
        synthesis::is_visible(choice.requested) ? RankGroup::kDrawn : choice.requested;
    meshes.adopt(handle, owner_of(row.entity), rank_on(node, landed, distance_m));
    return;
  }
  if (record != nullptr && record->state == synthesis::MeshState::kFailed) {
    demand.failed_levels |= static_cast<std::uint8_t>(1u << choice.request);
    return;
  }
  if (!tick.request) return;
  synthesis::Want want{key,
                       &source.parameters,
                       owner_of(row.entity),
                       rank_on(node, choice.requested, distance_m),
                       node.visibility.deadline_s,
                       choice.at_once};
  const bool awaited = demand.stale && node.level == 0 && demand.in_view_tick == tick.tick;
  if (awaited && tick.draft_s > 0) {
    tick.draft_s -= meshes.predict(want);
    want.at_once = true;
  }
  meshes.want(want);
}

// A single model that has become large enough to be drawn is lacked from this many times that size
// on. Until then it is asked for, and its node need not give way to a coarser one.
constexpr float kLackedFrom = 1.25F;

bool is_early(const ChoiceRules& rules, const NodeView& node, const Demand& demand,
              float size_pixels) {
  return rules.ask_early && node.level == 0 && demand.drawn_level == kNoLevel &&
         size_pixels < kLackedFrom * rules.min_size_pixels;
}

// Asks for a mesh that nothing lacks yet. The model counts as too small until it is there.
void ask_early(CacheTick& tick, NodeView node, const MeshEntity& row, bool in_view,
               float distance_m, synthesis::MeshSupply& meshes, Found& found) {
  node.covered = true;
  const MeshChoice choice =
      choose_mesh(tick.choice, node, row.detail, row.demand, in_view, /*is_ground=*/false);
  if (choice.request != kNoLevel) request(tick, node, row, choice, distance_m, meshes, found);
  row.demand.wanted_level = kNoLevel;
}

// Finds the level that the mesh should have, and how large a model is on screen: ground as large as
// can be.
float want_level(const CacheTick& tick, const NodeView& node, const MeshEntity& row, bool is_ground,
                 float distance_m) {
  Demand& demand = row.demand;
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

// What is done instead about a model in view that lacks nothing: it gets the finer level that will
// be wanted once it is there, and keeps it. That waits for all that is lacked.
MeshChoice look_ahead(const CacheTick& tick, const NodeView& node, const MeshEntity& row,
                      const glm::vec3& foot, const MeshChoice& here) {
  const Demand& demand = row.demand;
  const bool lacks = demand.stale || demand.drawn_level > demand.wanted_level;  // or has nothing
  const float ahead = glm::dot(foot, tick.soon);
  if (node.level > 0 || lacks || demand.wanted_level == 0 || ahead <= 0) return here;
  // From the nearest point of the way.
  const glm::vec3 moved = tick.soon * std::min(ahead / glm::dot(tick.soon, tick.soon), 1.0F);
  const float distance_m = distance_to(row.placed, foot - moved, tick.near_m);
  const float pixels =
      size_pixels(row.placed, row.detail, distance_m, tick.choice.pixels_per_radian, tick.near_m);
  Demand soon = demand;
  soon.wanted_level =
      model_level(tick.choice, node, row.detail, pixels, distance_m, demand.drawn_level);
  if (soon.wanted_level >= demand.wanted_level) return here;
  MeshChoice choice = choose_mesh(tick.choice, node, row.detail, soon, true, false);
  if (choice.request < demand.drawn_level) choice.requested = RankGroup::kPrefetch;
  return choice;
}

// Replaces the level that a model should have where it is by the one that it should have ready
// there out of view.
void want_out_of_view(const CacheTick& tick, const View& view, const NodeView& node,
                      const MeshEntity& row, const glm::vec3& foot,
                      const synthesis::MeshSupply& meshes) {
  Demand& demand = row.demand;
  const Outlook* const outlook = std::isfinite(node.visibility.deadline_s)
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
      meshes.ready(meshes.find(key_of(row.placed, row.detail, row.source, shown))) != nullptr)
    demand.wanted_level = shown;
}

// The ground of a node, or a model on it. False if there should be a mesh to draw and is none.
bool consider(CacheTick& tick, const View& view, const NodeView& node, const MeshEntity& row,
              bool is_ground, synthesis::MeshSupply& meshes, Found& found, Counters& counters) {
  const Placed& placed = row.placed;
  Demand& demand = row.demand;
  const glm::vec3 foot = node.corner + placed.position;
  const bool near = is_ground || node.level > 0;  // as near as the node itself
  const float distance_m =
      near ? node.visibility.distance_m : distance_to(placed, foot, tick.near_m);
  const bool in_view =
      node.in_view && (near || mesh_can_be_seen(box_of(row, tick.shadows), foot, view));
  const float pixels = want_level(tick, node, row, is_ground, distance_m);
  if (!in_view && !is_ground && !tick.shadows && tick.choice.levels_of_detail)
    want_out_of_view(tick, view, node, row, foot, meshes);
  if (demand.wanted_level != kNoLevel && is_early(tick.choice, node, demand, pixels)) {
    ask_early(tick, node, row, in_view, distance_m, meshes, found);
    return true;
  }
  if (in_view) {
    note_in_view(tick, node.leaf, demand, counters);
  } else {
    demand.seen_s = -1;
  }
  const bool drawn = demand.drawn_level != kNoLevel;
  if (demand.wanted_level == kNoLevel) {
    // Too small to be drawn: the first to go when room is needed.
    if (drawn) keep(tick, node, row, RankGroup::kUnwanted, distance_m, meshes);
    return true;
  }
  // Only holes ask: looking a mesh up takes time.
  const bool cached =
      tick.choice.coarse_first && is_hole(node, demand, in_view) &&
      meshes.ready(meshes.find(key_of(row.placed, row.detail, row.source, demand.wanted_level))) !=
          nullptr;
  MeshChoice choice =
      choose_mesh(tick.choice, node, row.detail, demand, in_view, is_ground, cached);
  if (in_view && !is_ground) choice = look_ahead(tick, node, row, foot, choice);
  if (drawn) keep(tick, node, row, choice.drawn, distance_m, meshes);
  if (choice.there) demand.requested_level = kNoLevel;
  if (choice.request != kNoLevel) request(tick, node, row, choice, distance_m, meshes, found);
  const unsigned all_levels = (1U << row.detail.level_count) - 1;
  return drawn || demand.failed_levels == all_levels || demand.added;
}

// visit(row) for these mesh entities. Returns for how many it was false.
template <class Visit>
std::uint32_t count_false(const CacheQuery& entities, std::span<const ecs::Entity> which,
                          const Visit& visit) {
  std::uint32_t count = 0;
  entities.each_of<const Placed, const Detail, const Source, const Mesh, Demand>(
      which, [&](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
                 std::span<const Detail> detail, std::span<const Source> source,
                 std::span<const Mesh> mesh, std::span<Demand> demand) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const MeshEntity row{rows[i], placed[i], detail[i], source[i], mesh[i], demand[i]};
          count += visit(row) ? 0 : 1;
        }
      });
  return count;
}

// visit(node, row, is_ground) for the meshes of every node of `nodes`, in this order; notes how
// many lack a mesh. `common` says what the nodes have in common.
template <class Visit>
void visit_nodes(const CacheQuery& entities, std::span<const ecs::Entity> nodes,
                 const core::WorldPosition& eye, double block_size_m, NodeView common,
                 const Visit& visit) {
  entities.each_of<const Node, const ecs::Children, const Visibility, Lacking>(
      nodes, [&](std::span<const ecs::Entity> rows, std::span<const Node> node,
                 std::span<const ecs::Children> models, std::span<const Visibility> visibility,
                 std::span<Lacking> lacking) {
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

// Those whose turn it is.
std::vector<ecs::Entity> every_nth(std::span<const ecs::Entity> nodes, std::size_t n,
                                   std::uint32_t tick) {
  std::vector<ecs::Entity> chosen;
  for (std::size_t i = tick % n; i < nodes.size(); i += n)
    chosen.push_back(nodes[i]);
  return chosen;
}

// Lazy evaluation keeps nothing: what the last frame drew is given back.
void forget_last_frame(const CacheQuery& entities, synthesis::MeshSupply& supply) {
  entities.each<Demand, const Mesh>([&supply](std::span<const ecs::Entity>,
                                              std::span<Demand> demands,
                                              std::span<const Mesh> meshes) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      supply.forget(meshes[i].handle);
      demands[i].drawn_level = kNoLevel;
    }
  });
}

// Entities whose mesh was taken to make room draw nothing until they get another one.
void drop_evicted(const CacheQuery& entities, synthesis::MeshSupply& meshes,
                  ecs::EventQueue<MeshEvicted>& evicted) {
  for (const synthesis::Eviction& eviction : meshes.take_evictions()) {
    const ecs::Entity owner = entity_of(eviction.owner);
    evicted.emit({owner, eviction.key});
    const Mesh* mesh = entities.get<Mesh>(owner);
    if (mesh != nullptr && mesh->handle == eviction.handle) {
      entities.get<Demand>(owner)->drawn_level = kNoLevel;
    }
    Fading* fading = entities.get<Fading>(owner);
    if (fading != nullptr && fading->old_mesh == eviction.handle) fading->old_mesh = {};
  }
}

synthesis::PlanLimits plan_limits(const Settings& settings, const Rules& rules, const Clock& clock,
                                  const Quality& quality, const Streaming& streaming,
                                  const Pressure& pressure) {
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
  if (quality.draft ||
      (pressure.waiting == 0 && clock.real_s - quality.awaiting_since_s > kCoarsePatienceSeconds))
    limits.here_up_to = RankGroup::kVisibleCoarse;
  return limits;
}

}  // namespace

void cache_system(const Settings& settings, const Rules& rules, const Clock& clock,
                  const Camera& camera, const Quality& quality, const WorldFacts& facts,
                  const Daylight& daylight, const Streaming& streaming, const View& view,
                  CacheQuery entities, const Assets& assets, const Output& output,
                  synthesis::MeshSupply& meshes, Found& found, Foresight& foresight,
                  Pressure& pressure, ecs::EventQueue<MeshEvicted>& evicted,
                  ecs::EventQueue<PlaceReady>& places_ready, Counters& counters) {
  if (!rules.keep) forget_last_frame(entities, meshes);
  meshes.begin_wants();
  assets.want_all(meshes);
  if (!quality.draft) want_pictures(facts, output, meshes);  // those of before are shown
  found.meshes.clear();
  // Before the picture's wants: where both want a mesh, it is the picture's.
  if (rules.request && !rules.settle)
    want_places({settings, facts, camera, quality, daylight}, foresight, meshes, places_ready);

  CacheTick tick{choice_rules(settings, rules, clock, camera, quality, facts, pressure),
                 clock.tick,
                 camera.projection.near_m,
                 rules.request,
                 is_roomy(meshes.stats()),
                 facts.shadows,
                 quality.draft && !rules.settle ? kDraftSeconds : 0};
  if (rules.look_ahead && !rules.settle && !quality.draft && !view.outlooks.empty())
    tick.soon = view.outlooks.front().moved * (kLandingSeconds / view.outlooks.front().tau_s);
  const auto visit = [&](std::span<const ecs::Entity> nodes, const NodeView& common) {
    visit_nodes(entities, nodes, camera.pose.position, facts.world.block_size_m(), common,
                [&](const NodeView& node, const MeshEntity& row, bool is_ground) {
                  return consider(tick, view, node, row, is_ground, meshes, found, counters);
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
  if (rules.look_ahead) {
    visit(view.expected, NodeView{});
    const std::vector<ecs::Entity> ready = every_nth(view.around, kAroundTurns, clock.tick);
    visit(ready, NodeView{.error_factor = kAroundErrorFactor, .around = true});
    const std::vector<ecs::Entity> kept = every_nth(view.kept, kAroundTurns, clock.tick);
    visit(kept, NodeView{.error_factor = kAroundErrorFactor, .around = true, .kept = true});
  }
  const synthesis::PlanReport report = meshes.plan(
      plan_limits(settings, rules, clock, quality, streaming, pressure), settings.policy);
  drop_evicted(entities, meshes, evicted);
  counters.requests = static_cast<std::uint32_t>(meshes.wants().size());
  counters.refused = report.refused;
  counters.refused_visible = report.refused_visible;
  pressure.refused_visible = report.refused_visible;
  pressure.waiting = report.waiting;
  pressure.seen_share = seen_share(meshes.stats());
  pressure.at_s = clock.real_s;
}

}  // namespace psygen::scene
