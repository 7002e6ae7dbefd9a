// Decides what every mesh entity should show, takes from the cache what it has, ranks what it
// keeps, and plans what is missing. Nodes that the picture depends on are looked at in every tick,
// front to back; those around the camera in turns.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/scene/draws/seen.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/systems.hpp"
#include "engine/visibility/level_choice.hpp"

namespace psygen::scene {
namespace {

using synthesis::Rank;
using synthesis::RankGroup;

// Nodes out of view are looked at once in so many ticks, and their models kept this much coarser.
constexpr std::size_t kAroundTurns = 8;
constexpr float kAroundErrorFactor = 2.0F;
// The rank of what is drawn is told to the cache anew when its group changes, otherwise once in so
// many ticks, or in every tick where little room is left: nothing else makes ranks matter.
constexpr std::uint32_t kRankTurns = 32;
// New meshes out of view that are reserved in a tick at least, if so many are wanted, while new
// nodes come.
constexpr std::uint32_t kFewestHidden = 48;
// So long a hole waits for the request that would fill it.
constexpr double kHolePatienceSeconds = 0.02;
// So long pictures may be too coarse before the main thread helps: modelers get only what others
// leave of the processors, and that can be nothing.
constexpr double kCoarsePatienceSeconds = 0.03;

// Where a node stands in the order of importance, in this tick.
struct NodeView {
  glm::vec3 corner{0.0F};  // relative to the camera
  const Visibility* visibility = nullptr;
  std::uint8_t level = 0;
  bool wanted = false;  // in view, or needed to draw what is
  bool in_view = false;
  bool covered = false;  // an ancestor can be drawn instead
  bool leaf = false;
  bool fine = false;
  float error_factor = 1;  // on that of the picture
  bool around = false;     // looked at in turns anyway
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

// Whether ranks do not matter: only what nobody wants need go.
bool is_roomy(const synthesis::CacheStats& stats) {
  constexpr double kRoomyShare = 0.8;
  return static_cast<double>(stats.bytes - std::min(stats.bytes, stats.unwanted_bytes)) <
         kRoomyShare * static_cast<double>(stats.limit_bytes);
}

// What is seen, as a share of what there is room for. What is kept only because it was there gives
// way, and says nothing of how much is needed.
double seen_share(const synthesis::CacheStats& stats) {
  return static_cast<double>(stats.visible_bytes) / static_cast<double>(stats.limit_bytes);
}

class Chooser {
 public:
  Chooser(const Settings& settings, const Rules& rules, const Clock& clock, const Camera& camera,
          const Quality& quality, const WorldFacts& facts, const View& view,
          const Pressure& pressure, synthesis::MeshSupply& meshes, Found& found, Counters& counters)
      : settings_(settings),
        rules_(rules),
        facts_(facts),
        quality_(quality),
        clock_(clock),
        camera_(camera),
        view_(view),
        pressure_(pressure),
        meshes_(meshes),
        found_(found),
        counters_(counters),
        roomy_(is_roomy(meshes.stats())) {}

  // The ground of a node, or a model on it. False if there should be a mesh to draw and is none.
  bool consider(const MeshEntity& row, const NodeView& node, bool is_ground) {
    const Placed& placed = row.placed;
    Demand& demand = row.demand;
    const glm::vec3 foot = node.corner + placed.position;
    const bool near = is_ground || node.level > 0;  // as near as the node itself
    const float distance_m =
        near ? node.visibility->distance_m : distance_to(placed, foot, camera_.projection.near_m);
    const bool in_view = node.in_view && (near || mesh_can_be_seen(box_of(row), foot, view_));
    demand.wanted_level = is_ground ? ground_level(row.detail, demand, node)
                                    : wanted_level(placed, row.detail, demand, distance_m, node);
    in_view ? note_in_view(demand, node.leaf) : note_out_of_view(demand);
    if (demand.wanted_level == kNoLevel) {
      // Too small to be drawn: the first to go when room is needed.
      if (demand.drawn_level != kNoLevel) keep(row, RankGroup::kUnwanted, node, distance_m);
      return true;
    }
    provide(row, node, in_view, is_ground, distance_m);
    const unsigned all_levels = (1U << row.detail.level_count) - 1;
    return demand.drawn_level != kNoLevel || demand.failed_levels == all_levels || demand.added;
  }

 private:
  // Around what is or was drawn, or all that could be; from the foot. What a mesh taught outlasts
  // it: otherwise one that is out of view would be a hole again as soon as it is evicted.
  core::Bounds box_of(const MeshEntity& row) const {
    if (row.mesh.tight != core::Bounds{} && !facts_.shadows) return row.mesh.tight;
    return core::Bounds::around(row.placed.box_center, row.placed.box_half_extent);
  }

  static std::uint8_t ground_level(const Detail& detail, const Demand& demand,
                                   const NodeView& node) {
    if (node.fine) return 0;
    if (!node.wanted && demand.drawn_level != kNoLevel) return demand.drawn_level;
    return static_cast<std::uint8_t>(detail.level_count - 1);
  }

  std::uint8_t wanted_level(const Placed& placed, const Detail& detail, const Demand& demand,
                            float distance_m, const NodeView& node) const {
    const float pixels = size_pixels(placed, detail, distance_m, camera_.pixels_per_radian,
                                     camera_.projection.near_m);
    if (node.level == 0 && pixels < static_cast<float>(settings_.min_size_pixels)) return kNoLevel;
    if (!settings_.levels_of_detail) return 0;
    const std::span<const float> errors(detail.error_m.data(), detail.level_count);
    const bool keep = demand.drawn_level != kNoLevel && !rules_.settle;
    const int current = keep ? demand.drawn_level : -1;
    const double error_pixels =
        node.level == 0 ? quality_.model_error_pixels : quality_.error_pixels;
    return static_cast<std::uint8_t>(
        visibility::choose_level(errors, distance_m, camera_.pixels_per_radian,
                                 node.error_factor * static_cast<float>(error_pixels), current));
  }

  void note_in_view(Demand& demand, bool leaf) {
    const bool entered = demand.in_view_tick + 1 != clock_.tick;
    if (entered) demand.entered_tick = clock_.tick;
    demand.in_view_tick = clock_.tick;
    if (demand.wanted_level == kNoLevel || !leaf) return;
    if (demand.drawn_level == kNoLevel) {
      if (demand.seen_s < 0) demand.seen_s = static_cast<float>(clock_.real_s);
    } else if (entered) {
      counters_.time_to_visible_ms.push_back(0.0F);
    }
  }

  static void note_out_of_view(Demand& demand) { demand.seen_s = -1; }

  Rank rank_of(RankGroup group, const NodeView& node, float distance_m) const {
    const Visibility& visibility = *node.visibility;
    // Where nothing can be drawn coarse nodes come first: they fill most with least.
    if (group == RankGroup::kVisibleHole)
      return Rank::hole(visibility::kMaxNodeLevel - node.level, visibility.layer, distance_m);
    if (synthesis::is_visible(group)) return Rank::by_layer(group, visibility.layer, distance_m);
    if (std::isfinite(visibility.deadline_s)) {
      return Rank::by_deadline(visibility.deadline_s, distance_m);
    }
    return Rank::by_layer(RankGroup::kPrefetch, visibility.layer, distance_m);
  }

  // Tells the cache how important the drawn mesh is, where that is due.
  void keep(const MeshEntity& row, RankGroup group, const NodeView& node, float distance_m) {
    const bool turn =
        node.around || (row.entity.index + clock_.tick) % (roomy_ ? kRankTurns : 1) == 0;
    std::uint8_t& ranked = row.demand.ranked;
    if (ranked == static_cast<std::uint8_t>(group) && !turn) return;
    ranked = static_cast<std::uint8_t>(group);
    meshes_.rank(row.mesh.handle, group == RankGroup::kUnwanted ? Rank::unwanted()
                                                                : rank_of(group, node, distance_m));
  }

  // Keeps what is drawn, and sees to it that the wanted level comes. Ground never gives way for
  // being too fine: it would open the picture.
  void provide(const MeshEntity& row, const NodeView& node, bool in_view, bool is_ground,
               float distance_m) {
    Demand& demand = row.demand;
    const bool wanted = in_view || (node.wanted && !node.in_view);
    const bool nothing = demand.drawn_level == kNoLevel;
    const bool hole = nothing && in_view && !node.covered;
    const bool there = demand.drawn_level == demand.wanted_level && !demand.stale;
    const std::uint8_t level = there ? kNoLevel : level_to_request(row, hole);
    const bool too_fine = !is_ground && !nothing && level != kNoLevel && level > demand.drawn_level;
    if (!nothing) {
      const RankGroup drawn = too_fine ? RankGroup::kVisibleFine : RankGroup::kDrawn;
      keep(row, wanted ? drawn : RankGroup::kPrefetch, node, distance_m);
    }
    if (there) demand.requested_level = kNoLevel;
    if (level == kNoLevel) return;
    RankGroup group = RankGroup::kPrefetch;
    if (hole) {
      group = RankGroup::kVisibleHole;
    } else if (wanted && level == demand.drawn_level) {
      // Ground that is only lit anew waits for what lacks detail: with a fast sun it is all of it.
      group = RankGroup::kDrawn;
    } else if (wanted) {  // what frees room is urgent only where room is short
      group =
          too_fine && quality_.coarsening > 1 ? RankGroup::kVisibleFine : RankGroup::kVisibleCoarse;
    }
    // Few nodes are so coarse, and each fills much of the picture.
    const bool root = is_ground && node.level + std::size_t{1} == facts_.levels.size();
    request(row, level, group, hole && root, node, distance_m);
  }

  // The wanted level; for a hole in view the coarsest one first; the nearest one to it where it
  // cannot be synthesised. kNoLevel if nothing is better than what is drawn.
  std::uint8_t level_to_request(const MeshEntity& row, bool hole) const {
    const Demand& demand = row.demand;
    const auto levels = static_cast<int>(row.detail.level_count);
    const bool coarse_first = hole && rules_.coarse_first && !is_cached(row, demand.wanted_level);
    // A modeler that holds the coarsest one may not get a processor for a while: then the next one.
    // Not where it waits for room.
    const bool stuck = !rules_.settle && quality_.coarsening <= 1 && pressure_.waiting == 0 &&
                       demand.seen_s >= 0 &&
                       clock_.real_s - double{demand.seen_s} > kHolePatienceSeconds;
    const int coarsest = stuck && levels > 1 ? levels - 2 : levels - 1;
    const int first = coarse_first ? coarsest : demand.wanted_level;
    for (int distance = 0; distance < levels; ++distance) {
      for (const int level : {first + distance, first - distance}) {
        if (level < 0 || level >= levels || (demand.failed_levels >> level & 1) != 0) continue;
        const bool there = level == demand.drawn_level && !demand.stale;
        return there ? kNoLevel : static_cast<std::uint8_t>(level);
      }
    }
    return kNoLevel;
  }

  synthesis::MeshKey key_of(const MeshEntity& row, std::uint8_t level) const {
    const Source& source = row.source;
    return {row.placed.block, source.index, source.model,
            static_cast<std::uint16_t>(source.first_level + level), source.parameters_hash};
  }

  bool is_cached(const MeshEntity& row, std::uint8_t level) const {
    return meshes_.ready(meshes_.find(key_of(row, level))) != nullptr;
  }

  void request(const MeshEntity& row, std::uint8_t level, RankGroup group, bool at_once,
               const NodeView& node, float distance_m) {
    const Source& source = row.source;
    Demand& demand = row.demand;
    const synthesis::MeshKey key = key_of(row, level);
    const bool first_time = demand.requested_level != level;
    demand.requested_level = level;
    const synthesis::MeshHandle handle = first_time ? meshes_.look_up(key) : meshes_.find(key);
    const synthesis::MeshRecord* record = meshes_.get(handle);
    if (record != nullptr && record->state == synthesis::MeshState::kReady) {
      found_.meshes.push_back({row.entity, handle});
      // The entity that asked for it may have been destroyed; evictions are reported to the owner.
      const RankGroup landed = synthesis::is_visible(group) ? RankGroup::kDrawn : group;
      meshes_.adopt(handle, owner_of(row.entity), rank_of(landed, node, distance_m));
      return;
    }
    if (record != nullptr && record->state == synthesis::MeshState::kFailed) {
      demand.failed_levels |= static_cast<std::uint8_t>(1u << level);
      return;
    }
    if (!rules_.request) return;
    meshes_.want({key, &source.parameters, owner_of(row.entity), rank_of(group, node, distance_m),
                  node.visibility->deadline_s, at_once});
  }

  const Settings& settings_;
  const Rules& rules_;
  const WorldFacts& facts_;
  const Quality& quality_;
  const Clock& clock_;
  const Camera& camera_;
  const View& view_;
  const Pressure& pressure_;
  synthesis::MeshSupply& meshes_;
  Found& found_;
  Counters& counters_;
  const bool roomy_;
};

// Looks at nodes and their models.
class NodeWalk {
 public:
  NodeWalk(Chooser& chooser, const Camera& camera, double block_size_m, const CacheQuery& entities)
      : chooser_(chooser), camera_(camera), block_size_m_(block_size_m), entities_(entities) {}

  void consider(std::span<const ChosenNode> nodes, bool only_leaves) {
    for (const ChosenNode& node : nodes) {
      if (only_leaves && !(node.leaf && node.in_view)) continue;
      consider(std::span(&node.entity, 1), {.wanted = true,
                                            .in_view = node.in_view,
                                            .covered = node.covered,
                                            .leaf = node.leaf,
                                            .fine = node.fine});
    }
  }

  // Every node of `entities`, in this order; `view` says what they have in common.
  void consider(std::span<const ecs::Entity> nodes, NodeView view) {
    entities_.each_of<const Node, const ecs::Children, const Visibility, Lacking>(
        nodes, [&](std::span<const ecs::Entity> rows, std::span<const Node> node,
                   std::span<const ecs::Children> models, std::span<const Visibility> visibility,
                   std::span<Lacking> lacking) {
          for (std::size_t i = 0; i < rows.size(); ++i) {
            const core::BlockCoord corner = visibility::corner_block(node[i].at);
            view.corner = glm::vec3(core::offset_m(corner, camera_.pose.position, block_size_m_));
            view.visibility = &visibility[i];
            view.level = node[i].at.level;
            lacking[i].meshes = consider_rows(rows.subspan(i, 1), view, true) +
                                consider_rows(entities_.children(models[i]), view, false);
          }
        });
  }

 private:
  // Returns how many lack a mesh.
  std::uint32_t consider_rows(std::span<const ecs::Entity> entities, const NodeView& view,
                              bool is_ground) {
    std::uint32_t lacking = 0;
    entities_.each_of<const Placed, const Detail, const Source, const Mesh, Demand>(
        entities, [&](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
                      std::span<const Detail> detail, std::span<const Source> source,
                      std::span<const Mesh> mesh, std::span<Demand> demand) {
          for (std::size_t i = 0; i < rows.size(); ++i) {
            const bool there = chooser_.consider(
                {rows[i], placed[i], detail[i], source[i], mesh[i], demand[i]}, view, is_ground);
            lacking += there ? 0 : 1;
          }
        });
    return lacking;
  }

  Chooser& chooser_;
  const Camera& camera_;
  double block_size_m_;
  CacheQuery entities_;
};

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
  if (pressure.waiting == 0 && clock.real_s - quality.awaiting_since_s > kCoarsePatienceSeconds)
    limits.here_up_to = RankGroup::kVisibleCoarse;
  return limits;
}

}  // namespace

void cache_system(const Settings& settings, const Rules& rules, const Clock& clock,
                  const Camera& camera, const Quality& quality, const WorldFacts& facts,
                  const Streaming& streaming, const View& view, CacheQuery entities,
                  synthesis::MeshSupply& meshes, Found& found, Foresight& foresight,
                  Pressure& pressure, ecs::EventQueue<MeshEvicted>& evicted,
                  ecs::EventQueue<PlaceReady>& places_ready, Counters& counters) {
  if (!rules.keep) forget_last_frame(entities, meshes);
  meshes.begin_wants();
  found.meshes.clear();
  // Before the picture's wants: where both want a mesh, it is the picture's.
  if (rules.request && !rules.settle)
    want_places(settings.modelers, foresight, meshes, places_ready);

  Chooser chooser(settings, rules, clock, camera, quality, facts, view, pressure, meshes, found,
                  counters);
  NodeWalk walk(chooser, camera, facts.world.block_size_m(), entities);
  walk.consider(view.chosen, rules.wait);
  if (rules.look_ahead) {
    walk.consider(view.expected, NodeView{});
    std::vector<ecs::Entity> around;  // those whose turn it is
    for (std::size_t i = clock.tick % kAroundTurns; i < view.around.size(); i += kAroundTurns)
      around.push_back(view.around[i]);
    walk.consider(around, NodeView{.error_factor = kAroundErrorFactor, .around = true});
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
