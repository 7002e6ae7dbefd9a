// Decides what every mesh entity of the window should show, takes from the cache what it has, ranks
// what it keeps, and plans what is missing. Blocks in view are looked at in every tick in PLP
// order; those around the camera in turns.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/core/log.hpp"
#include "engine/scene/systems.hpp"
#include "engine/visibility/level_choice.hpp"

namespace psygen::scene {
namespace {

using synthesis::Rank;
using synthesis::RankGroup;

// Blocks out of view are looked at once in so many ticks, and kept this much coarser.
constexpr std::size_t kAroundTurns = 8;
constexpr float kAroundErrorFactor = 2.0F;
// So long a hole waits for the request that would fill it.
constexpr double kHolePatienceSeconds = 0.02;
// A terrain's error is the sum of what all octaves could lose at worst; seen is about half of it.
constexpr float kTerrainErrorFactor = 2.0F;

// Where a block stands in the order of importance, in this tick.
struct BlockView {
  glm::vec3 corner{0.0F};  // relative to the camera
  const Visibility* visibility = nullptr;
  bool in_view = false;
  float error_pixels = 0;
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

class Chooser {
 public:
  Chooser(const Settings& settings, const Clock& clock, const Camera& camera,
          const visibility::Frustum& frustum, Synthesis& synthesis, Counters& counters)
      : settings_(settings),
        clock_(clock),
        camera_(camera),
        frustum_(frustum),
        synthesis_(synthesis),
        counters_(counters) {}

  void consider(const MeshEntity& row, const BlockView& block, bool is_terrain) {
    const Placed& placed = row.placed;
    Demand& demand = row.demand;
    const glm::vec3 center = block.corner + placed.position + placed.box_center;
    const float distance_m =
        is_terrain ? block.visibility->distance_m
                   : std::max(glm::length(center) - placed.radius_m, camera_.projection.near_m);
    const bool in_view =
        block.in_view &&
        (is_terrain || visibility::intersects(frustum_, {center - placed.box_half_extent,
                                                         center + placed.box_half_extent}));
    demand.wanted_level =
        wanted_level(placed, row.detail, demand, distance_m, block.error_pixels, is_terrain);
    in_view ? note_in_view(demand) : note_out_of_view(demand);
    if (demand.wanted_level == kNoLevel) {
      // Too small to be drawn: the first to go when room is needed.
      if (demand.drawn_level != kNoLevel) {
        synthesis_.cache->set_rank(row.mesh.handle, Rank::unwanted());
      }
      return;
    }
    provide(row, in_view, *block.visibility, distance_m);
  }

 private:
  std::uint8_t wanted_level(const Placed& placed, const Detail& detail, const Demand& demand,
                            float distance_m, float error_pixels, bool is_terrain) const {
    const float size_pixels = 2 * placed.radius_m * camera_.pixels_per_radian /
                              std::max(distance_m + placed.radius_m, camera_.projection.near_m);
    if (!is_terrain && size_pixels < static_cast<float>(settings_.min_size_pixels)) return kNoLevel;
    if (!settings_.levels_of_detail) return 0;
    const std::span<const float> errors(detail.error_m.data(), detail.level_count);
    if (is_terrain) error_pixels *= kTerrainErrorFactor;
    const bool keep = demand.drawn_level != kNoLevel && !synthesis_.settling;
    const int current = keep ? demand.drawn_level : -1;
    return static_cast<std::uint8_t>(visibility::choose_level(
        errors, distance_m, camera_.pixels_per_radian, error_pixels, current));
  }

  void note_in_view(Demand& demand) {
    const bool entered = demand.in_view_tick + 1 != clock_.tick;
    demand.in_view_tick = clock_.tick;
    if (demand.wanted_level == kNoLevel) return;
    if (demand.drawn_level == kNoLevel) {
      if (demand.seen_s < 0) demand.seen_s = static_cast<float>(clock_.real_s);
    } else if (entered) {
      counters_.time_to_visible_ms.push_back(0.0F);
    }
  }

  static void note_out_of_view(Demand& demand) { demand.seen_s = -1; }

  Rank rank_of(RankGroup group, const Visibility& visibility, float distance_m) const {
    if (synthesis::is_visible(group)) return Rank::by_layer(group, visibility.layer, distance_m);
    if (std::isfinite(visibility.deadline_s)) {
      return Rank::by_deadline(visibility.deadline_s, distance_m);
    }
    return Rank::by_layer(RankGroup::kPrefetch, visibility.layer, distance_m);
  }

  // Keeps what is drawn, and sees to it that the wanted level comes.
  void provide(const MeshEntity& row, bool in_view, const Visibility& visibility,
               float distance_m) {
    Demand& demand = row.demand;
    if (demand.drawn_level != kNoLevel) {
      const RankGroup kept = in_view ? RankGroup::kDrawn : RankGroup::kPrefetch;
      synthesis_.cache->set_rank(row.mesh.handle, rank_of(kept, visibility, distance_m));
    }
    if (demand.drawn_level == demand.wanted_level) {
      demand.requested_level = kNoLevel;
      return;
    }
    const bool hole = demand.drawn_level == kNoLevel;
    const std::uint8_t level = level_to_request(row, hole && in_view);
    if (level == kNoLevel) return;
    const RankGroup group = !in_view ? RankGroup::kPrefetch
                            : hole   ? RankGroup::kVisibleHole
                                     : RankGroup::kVisibleCoarse;
    request(row, level, rank_of(group, visibility, distance_m), visibility.deadline_s);
  }

  // The wanted level; for a hole in view the coarsest one first; the nearest one to it where it
  // cannot be synthesised. kNoLevel if nothing is better than what is drawn.
  std::uint8_t level_to_request(const MeshEntity& row, bool hole) const {
    const Demand& demand = row.demand;
    const auto levels = static_cast<int>(row.detail.level_count);
    const bool coarse_first = hole && settings_.levels_of_detail &&
                              settings_.paradigm == Paradigm::kParallelLazyAmplification;
    // A modeler that holds the coarsest one may not get a processor for a while: then the next one.
    const bool stuck = !synthesis_.settling && demand.seen_s >= 0 &&
                       clock_.real_s - double{demand.seen_s} > kHolePatienceSeconds;
    const int coarsest = stuck && levels > 1 ? levels - 2 : levels - 1;
    const int first = coarse_first ? coarsest : demand.wanted_level;
    for (int distance = 0; distance < levels; ++distance) {
      for (const int level : {first + distance, first - distance}) {
        if (level < 0 || level >= levels || (demand.failed_levels >> level & 1) != 0) continue;
        return level == demand.drawn_level ? kNoLevel : static_cast<std::uint8_t>(level);
      }
    }
    return kNoLevel;
  }

  void request(const MeshEntity& row, std::uint8_t level, Rank rank, float deadline_s) {
    const Source& source = row.source;
    Demand& demand = row.demand;
    const synthesis::MeshKey key{row.placed.block, source.index, source.model, level,
                                 source.parameters_hash};
    const bool first_time = demand.requested_level != level;
    demand.requested_level = level;
    const synthesis::MeshHandle handle =
        first_time ? synthesis_.cache->look_up(key) : synthesis_.cache->find(key);
    const synthesis::MeshRecord* record = synthesis_.cache->get(handle);
    if (record != nullptr && record->state == synthesis::MeshState::kReady) {
      synthesis_.ready.push_back({row.entity, handle});
      // The entity that asked for it may have been destroyed; evictions are reported to the owner.
      synthesis_.cache->adopt(handle, owner_of(row.entity), rank);
      return;
    }
    if (record != nullptr && record->state == synthesis::MeshState::kFailed) {
      demand.failed_levels |= static_cast<std::uint8_t>(1u << level);
      return;
    }
    if (settings_.paradigm == Paradigm::kDataAmplification) return;
    synthesis_.wants.push_back({key, &source.parameters, owner_of(row.entity), rank, deadline_s});
  }

  const Settings& settings_;
  const Clock& clock_;
  const Camera& camera_;
  const visibility::Frustum& frustum_;
  Synthesis& synthesis_;
  Counters& counters_;
};

// Looks at these blocks and their models, in this order.
class BlockWalk {
 public:
  BlockWalk(Chooser& chooser, const Camera& camera, double block_size_m, const CacheQuery& entities)
      : chooser_(chooser), camera_(camera), block_size_m_(block_size_m), entities_(entities) {}

  void consider(std::span<const ecs::Entity> blocks, bool in_view, float error_pixels) {
    entities_.each_of<const Block, const ecs::Children, const Visibility>(
        blocks, [&](std::span<const ecs::Entity> rows, std::span<const Block> block,
                    std::span<const ecs::Children> models, std::span<const Visibility> visibility) {
          for (std::size_t i = 0; i < rows.size(); ++i) {
            const glm::vec3 corner(
                core::offset_m(block[i].coord, camera_.pose.position, block_size_m_));
            const BlockView view{corner, &visibility[i], in_view, error_pixels};
            consider_rows(rows.subspan(i, 1), view, true);
            consider_rows(entities_.children(models[i]), view, false);
          }
        });
  }

 private:
  void consider_rows(std::span<const ecs::Entity> entities, const BlockView& view,
                     bool is_terrain) {
    entities_.each_of<const Placed, const Detail, const Source, const Mesh, Demand>(
        entities, [&](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
                      std::span<const Detail> detail, std::span<const Source> source,
                      std::span<const Mesh> mesh, std::span<Demand> demand) {
          for (std::size_t i = 0; i < rows.size(); ++i) {
            chooser_.consider({rows[i], placed[i], detail[i], source[i], mesh[i], demand[i]}, view,
                              is_terrain);
          }
        });
  }

  Chooser& chooser_;
  const Camera& camera_;
  double block_size_m_;
  CacheQuery entities_;
};

// Lazy evaluation keeps nothing: what the last frame drew is given back.
void forget_last_frame(const CacheQuery& entities, Synthesis& synthesis) {
  entities.each<Demand, const Mesh>([&synthesis](std::span<const ecs::Entity>,
                                                 std::span<Demand> demands,
                                                 std::span<const Mesh> meshes) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      synthesis.cache->release(meshes[i].handle);
      demands[i].drawn_level = kNoLevel;
    }
  });
}

// Entities whose mesh was taken to make room draw nothing until they get another one.
void drop_evicted(const CacheQuery& entities, Synthesis& synthesis) {
  for (const synthesis::Eviction& eviction : synthesis.cache->take_evictions()) {
    const ecs::Entity owner = entity_of(eviction.owner);
    const Mesh* mesh = entities.get<Mesh>(owner);
    if (mesh != nullptr && mesh->handle == eviction.handle) {
      entities.get<Demand>(owner)->drawn_level = kNoLevel;
    }
  }
}

// Under pressure everything gets coarser, and finer again when there is room: quickly up, slowly
// down.
void adapt_to_budget(const Settings& settings, const synthesis::PlanReport& report,
                     Synthesis& synthesis, Totals& totals) {
  constexpr float kUp = 1.15F, kDown = 0.99F, kCoarsest = 64.0F;
  const bool roomy = static_cast<double>(synthesis.cache->stats().bytes) <
                     0.8 * static_cast<double>(synthesis.cache->budget_bytes());
  if (report.refused > 0) {
    synthesis.coarsening = std::min(synthesis.coarsening * kUp, kCoarsest);
    if (!totals.warned_budget) {
      totals.warned_budget = true;
      core::log_warning(
          settings.levels_of_detail
              ? "the geometry budget is too small for this view; drawing coarser levels"
              : "the geometry budget is too small for this view at full detail; some of it is "
                "missing");
    }
  } else if (roomy) {
    synthesis.coarsening = std::max(synthesis.coarsening * kDown, 1.0F);
  }
}

}  // namespace

void cache_system(const Settings& settings, const Clock& clock, const Camera& camera,
                  const WorldFacts& facts, const View& view, CacheQuery entities,
                  Synthesis& synthesis, Counters& counters, Totals& totals) {
  if (settings.paradigm == Paradigm::kLazyEvaluation) forget_last_frame(entities, synthesis);
  synthesis.wants.clear();
  synthesis.ready.clear();

  Chooser chooser(settings, clock, camera, view.frustum, synthesis, counters);
  BlockWalk walk(chooser, camera, facts.world.block_size_m(), entities);
  const float error_pixels = static_cast<float>(settings.max_error_pixels) * synthesis.coarsening;
  walk.consider(view.visible, true, error_pixels);
  if (settings.paradigm == Paradigm::kParallelLazyAmplification) {
    walk.consider(view.expected, false, error_pixels);
    std::vector<ecs::Entity> around;  // those whose turn it is
    for (std::size_t i = clock.tick % kAroundTurns; i < view.around.size(); i += kAroundTurns)
      around.push_back(view.around[i]);
    walk.consider(around, false, error_pixels * kAroundErrorFactor);
  }
  const bool wait = settings.paradigm == Paradigm::kLazyEvaluation;
  synthesis::PlanLimits limits;
  limits.seconds_ahead =
      wait ? std::numeric_limits<double>::infinity() : settings.plan_seconds_ahead;
  limits.max_requests = wait ? UINT32_MAX : settings.plan_max_requests;
  limits.seconds_here = wait ? 0.0 : settings.hole_budget_ms / 1000.0;
  const synthesis::PlanReport report =
      synthesis.planner->plan(synthesis.wants, *synthesis.cache, *synthesis.cost,
                              *synthesis.manager, limits, settings.policy);
  counters.requests = static_cast<std::uint32_t>(synthesis.wants.size());
  counters.refused = static_cast<std::uint32_t>(report.refused);
  drop_evicted(entities, synthesis);
  adapt_to_budget(settings, report, synthesis, totals);
}

}  // namespace psygen::scene
