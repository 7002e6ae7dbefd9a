#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/scene_draws.hpp"
#include "engine/scene/view/debug_colours.hpp"
#include "engine/scene/view/visibility.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::scene {
namespace {

constexpr std::uint8_t kNone = ObjectState::kNoLevel;
// Maximum distance in metres from which objects out of view cast shadows into the frame.
constexpr float kShadowReachM = 120.0F;
// An LOD stays until another is better by this factor.
constexpr float kLevelSlack = 1.25F;
// Ticks between look-ups of the ground's shadow on an object.
constexpr std::uint32_t kSunTurns = 8;

// An object relative to the camera.
struct Place {
  glm::vec3 foot{0.0F}, centre{0.0F};
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
  float radius_m = 0, distance_m = 0, scale = 1;
  bool in_view = false;
  bool near = false;    // in view, or its shadow may be
  bool wanted = false;  // visible, large and near enough to be drawn
};

bool place_of(const Transform& transform, const core::Bounds& box,
              const core::WorldPosition& camera, double block_size_m, Place& place) {
  if (!is_valid(transform)) return false;
  place.rotation = glm::normalize(transform.rotation);
  place.foot = offset_of(transform.position, camera, block_size_m);
  const glm::vec3 size = glm::abs(transform.scale);
  place.scale = std::max({size.x, size.y, size.z});
  place.centre = place.foot + place.rotation * (transform.scale * box.centre());
  place.radius_m = glm::length(box.half_extent() * size);
  place.distance_m = glm::length(place.centre);
  return true;
}

// Finds the cached mesh of an LOD, once a tick.
ObjectMeshLevel& refresh(Assets& assets, MeshId id, std::uint32_t number, std::uint32_t tick,
                         const synthesis::MeshSupply& supply) {
  ObjectMeshLevel& level = assets.mesh(id).levels[number];
  if (level.tick == tick) return level;
  level.tick = tick;
  level.seen = level.hole = false;
  level.nearest_m = level.hole_m = 1e9F;
  const synthesis::MeshRecord* record = supply.get(level.handle);
  if (record == nullptr) {
    level.handle = supply.find(level.key);
    record = supply.get(level.handle);
  }
  level.ready = record != nullptr && record->state == synthesis::MeshState::kReady;
  level.failed = record != nullptr && record->state == synthesis::MeshState::kFailed;
  if (level.ready) level.range = record->range;
  assets.used.push_back({id, number});
  return level;
}

// The coarsest LOD whose error is not visible.
std::uint32_t wanted_level(const ObjectMesh& mesh, const Place& place, std::uint8_t drawn,
                           const RenderContext& context) {
  if (!context.frame.settings.levels_of_detail) return 0;
  const float away = std::max(place.distance_m - place.radius_m, context.camera.projection.near_m);
  std::uint32_t level = 0;
  while (level + 1 < mesh.level_count) {
    const float slack = drawn != kNone && level + 1 > drawn ? kLevelSlack : 1.0F;
    const float pixels =
        mesh.levels[level + 1].error_m * place.scale * context.camera.pixels_per_radian / away;
    if (pixels * slack > static_cast<float>(context.quality.model_error_pixels)) break;
    ++level;
  }
  return level;
}

// The ready LOD nearest to the wanted one, coarser ones first; kNone if none is ready.
std::uint8_t available_level(Assets& assets, MeshId id, std::uint32_t wanted, std::uint32_t tick,
                             const synthesis::MeshSupply& supply) {
  if (refresh(assets, id, wanted, tick, supply).ready) return static_cast<std::uint8_t>(wanted);
  const std::uint32_t count = assets.mesh(id).level_count;
  for (std::uint32_t away = 1; away < count; ++away) {
    for (const std::int64_t level : {std::int64_t{wanted} + away, std::int64_t{wanted} - away}) {
      if (level < 0 || level >= count) continue;
      // A look-up only: it does not request the mesh.
      const ObjectMeshLevel& other = assets.mesh(id).levels[static_cast<std::size_t>(level)];
      const synthesis::MeshRecord* record = supply.ready(supply.find(other.key));
      if (record == nullptr) continue;
      refresh(assets, id, static_cast<std::uint32_t>(level), tick, supply);
      return static_cast<std::uint8_t>(level);
    }
  }
  return kNone;
}

// Advances the fade of an object that is drawn at `level`.
void advance_fade_in(ObjectState& state, std::uint8_t level, bool fades_in, FadeStep step) {
  if (state.drawn_tick + 1 != step.tick) {
    state.share = fades_in ? 0.0F : 1.0F;
    state.level = level;
    state.old_level = kNone;
  } else if (level != state.level) {
    const bool whole = state.share >= 1.0F;
    state.old_level = whole ? state.level : kNone;
    if (whole) state.share = 0.0F;
    state.level = level;
  }
  state.drawn_tick = step.tick;
  state.share = std::min(state.share + step.share, 1.0F);
  if (state.share >= 1.0F) state.old_level = kNone;
}

// Advances the fade of an object that is no longer drawn. Returns false once it has faded out.
bool advance_fade_out(ObjectState& state, FadeStep step) {
  if (state.drawn_tick + 1 != step.tick || state.level == kNone) return false;
  state.old_level = kNone;
  state.share = std::max(state.share - step.share, 0.0F);
  if (state.share > 0) state.drawn_tick = step.tick;
  return state.share > 0;
}

// Drops LODs of a former mesh: a game may give an object another mesh with fewer LODs.
void forget_other_levels(ObjectState& state, std::uint32_t level_count) {
  if (state.level != kNone && state.level >= level_count)
    state.level = static_cast<std::uint8_t>(level_count - 1);
  if (state.old_level >= level_count) state.old_level = kNone;
}

class ObjectWalk {
 public:
  ObjectWalk(FadeStep step, const RenderContext& context, const ObjectQuery& entities,
             const ObjectWork& work)
      : step_(step),
        context_(context),
        entities_(entities),
        work_(work),
        block_size_m_(context.facts.world.block_size_m()) {}

  void visit(ecs::Entity entity, const Transform& transform, Object& object) {
    level_ = kNone;
    if (!work_.assets.exists(object.mesh)) return;
    const ObjectMesh& mesh = work_.assets.mesh(object.mesh);
    Place place;
    if (!place_of(transform, mesh.box, context_.camera.pose.position, block_size_m_, place)) {
      ++work_.draws.counts.invalid;
      return;
    }
    forget_other_levels(object.state, mesh.level_count);
    const float away = place.distance_m - place.radius_m;
    const core::Bounds box = core::Bounds::around(place.centre, glm::vec3(place.radius_m));
    place.in_view = may_be_visible(box, context_.view);
    place.near = place.in_view || (context_.facts.shadows && away < kShadowReachM);
    const SceneSettings& settings = context_.frame.settings;
    const float pixels = 2 * place.radius_m * context_.camera.pixels_per_radian /
                         std::max(place.distance_m, context_.camera.projection.near_m);
    place.wanted = object.visible && pixels >= static_cast<float>(settings.min_size_pixels) &&
                   away <= static_cast<float>(settings.view_distance_m);
    if (place.wanted) use(object, place, mesh);
    if (place.near) draw(entity, transform, object, place);
    if (!place.in_view) return;
    object.state.in_view_tick = step_.tick;
    object.state.fresh = false;
  }

 private:
  // Records the LOD that the object needs; finds the LOD to draw.
  void use(Object& object, const Place& place, const ObjectMesh& mesh) {
    const std::uint32_t wanted = wanted_level(mesh, place, object.state.level, context_);
    ObjectMeshLevel& level = refresh(work_.assets, object.mesh, wanted, step_.tick, work_.supply);
    level.nearest_m = std::min(level.nearest_m, place.distance_m);
    level.seen = level.seen || place.in_view;
    if (!place.near) return;
    level_ = level.ready
                 ? static_cast<std::uint8_t>(wanted)
                 : available_level(work_.assets, object.mesh, wanted, step_.tick, work_.supply);
    if (level_ != kNone) {
      ObjectMeshLevel& drawn = work_.assets.mesh(object.mesh).levels[level_];
      drawn.seen = drawn.seen || place.in_view;
      drawn.nearest_m = std::min(drawn.nearest_m, place.distance_m);
      return;
    }
    if (!place.in_view || level.failed) return;
    level.hole = true;
    level.hole_m = std::min(level.hole_m, place.distance_m);
    ++work_.draws.counts.missing;
  }

  void draw(ecs::Entity entity, const Transform& transform, Object& object, const Place& place) {
    ObjectState& state = object.state;
    if (place.wanted && level_ == kNone) return;
    float fade = 1.0F;
    if (place.wanted) {
      const bool was_in_view = state.in_view_tick + 1 == step_.tick;
      advance_fade_in(state, level_,
                      step_.continues && place.in_view && (state.fresh || was_in_view), step_);
      fade = state.share;
    } else {
      if (!place.in_view || !advance_fade_out(state, step_)) return;
      if (!refresh(work_.assets, object.mesh, state.level, step_.tick, work_.supply).ready) return;
      fade = state.share - 1.0F;
    }
    if (state.fresh || (step_.tick + entity.index) % kSunTurns == 0)
      state.sun = ground_sun_at(transform.position, block_size_m_, context_.streaming, entities_);
    work_.draws.counts.drawn += place.in_view ? 1 : 0;
    add(entity, transform, object, place, state.level, fade);
    if (!place.wanted || state.old_level == kNone) return;
    if (refresh(work_.assets, object.mesh, state.old_level, step_.tick, work_.supply).ready)
      add(entity, transform, object, place, state.old_level, -state.share);
  }

  void add(ecs::Entity entity, const Transform& transform, const Object& object, const Place& place,
           std::uint8_t level, float fade) {
    const ObjectMesh& mesh = work_.assets.mesh(object.mesh);
    render::ObjectDraw& draw = work_.draws.objects.emplace_back();
    draw.range = mesh.levels[level].range;
    draw.material = object.material;
    draw.origin = place.foot;
    draw.rotation = {place.rotation.x, place.rotation.y, place.rotation.z, place.rotation.w};
    draw.scale = transform.scale;
    draw.box_centre = mesh.box.centre();
    draw.box_half_extent = mesh.box.half_extent();
    draw.fade = fade;
    draw.sun = object.state.sun;
    draw.phase = static_cast<float>(entity.index % 64) * (1.0F / 64.0F);
    draw.name = entity.index;
    if (context_.input.view != render::View::kNormal)
      draw.debug_colour = colour_of(context_.input.view, {.level = level});
  }

  FadeStep step_;
  const RenderContext& context_;
  const ObjectQuery& entities_;
  const ObjectWork& work_;
  double block_size_m_;
  std::uint8_t level_ = kNone;  // LOD to draw of the visited object
};

// Ranks all meshes that objects use, or used in the last tick.
void rank_meshes(std::uint32_t tick, double block_size_m, const ObjectWork& work) {
  auto& [supply, assets, draws] = work;
  using synthesis::Rank;
  using synthesis::RankGroup;
  draws.meshes.clear();
  for (const auto& [id, number] : assets.used) {
    const ObjectMeshLevel& level = assets.mesh(id).levels[number];
    if (!level.ready) continue;
    if (level.seen) draws.meshes.push_back(level.handle);
    const auto layer = static_cast<std::uint32_t>(level.nearest_m / block_size_m);
    supply.rank(level.handle, level.seen ? Rank(RankGroup::kDrawn, 0, level.nearest_m)
                                         : Rank(RankGroup::kPrefetch, layer, level.nearest_m));
  }
  for (const auto& [id, number] : assets.used_before) {
    if (!assets.exists(id)) continue;
    const ObjectMeshLevel& level = assets.mesh(id).levels[number];
    if (level.tick != tick && level.ready) supply.rank(level.handle, Rank::unwanted());
  }
  supply.note_drawn(draws.meshes);
}

}  // namespace

void objects_system(RenderContext context, ObjectQuery entities, ObjectWork work) {
  ObjectDraws& draws = work.draws;
  FadeStep step = next_fade_step(context.frame, draws.last);
  if (context.frame.rules.settle) step.share = 1.0F;
  draws.objects.clear();
  work.assets.forget_removed(work.supply);
  work.assets.used_before.swap(work.assets.used);
  work.assets.used.clear();
  ObjectWalk walk(step, context, entities, work);
  entities.each<const Transform, Object>([&](auto rows, auto transforms, auto objects) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      walk.visit(rows[i], transforms[i], objects[i]);
  });
  rank_meshes(step.tick, context.facts.world.block_size_m(), work);
}

}  // namespace psygen::scene
