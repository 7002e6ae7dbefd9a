#include "game/show/scenery.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "ecs/ecs.hpp"
#include "engine/core/mesh_data.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/effects.hpp"
#include "engine/scene/objects/particle_kinds.hpp"
#include "engine/world/world.hpp"

namespace cairns {
namespace {

constexpr double kFallS = 1.7, kLiesS = 5;
constexpr double kNightEyes = 2, kDuskH = 7;  // hours from noon
constexpr float kBeaconM = 3.2F;              // height of a hidden cairn
constexpr glm::vec3 kEmber{1.0F, 0.50F, 0.18F};

glm::quat turned(double yaw, double pitch = 0) {
  return glm::angleAxis(static_cast<float>(-yaw), glm::vec3(0, 1, 0)) *
         glm::angleAxis(static_cast<float>(pitch), glm::vec3(1, 0, 0));
}

std::uint64_t name_of_place(const core::WorldPosition& at) {
  return core::combine(cell_name(at.block.x, at.block.z),
                       static_cast<std::uint64_t>(at.local.x * 64) << 20 ^
                           static_cast<std::uint64_t>(at.local.z * 64));
}

core::WorldPosition raised(core::WorldPosition at, double up_m) {
  at.local.y += up_m;
  return at;
}

// Smoke of a hidden cairn, visible from far away.
render::ParticleKind beacon_smoke() {
  render::ParticleKind kind = scene::smoke({0.4F, 0, 0.2F});
  kind.lifetime_s = 14;
  kind.rate = 7;
  kind.velocity = {0, 2.6F, 0};
  kind.first_size_m = 0.7F;
  kind.last_size_m = 6.5F;
  kind.first_colour = {0.75F, 0.76F, 0.80F, 0.55F};
  kind.last_colour = {0.8F, 0.8F, 0.84F, 0.0F};
  return kind;
}

using core::add_ellipsoid, core::add_triangle;

std::array<Part, kParts> deer() {
  const glm::vec3 coat(0.19F, 0.105F, 0.05F), pale(0.42F, 0.33F, 0.24F), dark(0.06F, 0.04F, 0.03F);
  std::array<Part, kParts> parts;
  core::MeshData& body = parts[0].mesh;
  add_ellipsoid(body, {0, 0.92F, 0}, {0.21F, 0.25F, 0.55F}, coat, pale);
  add_ellipsoid(body, {0, 1.17F, -0.55F}, {0.10F, 0.30F, 0.13F}, coat, coat);
  add_ellipsoid(body, {0, 1.42F, -0.70F}, {0.085F, 0.10F, 0.19F}, coat, pale);
  add_ellipsoid(body, {0, 1.03F, 0.54F}, {0.07F, 0.09F, 0.06F}, pale, pale);
  for (const float side : {-1.0F, 1.0F}) {
    add_triangle(body,
                 {glm::vec3(side * 0.04F, 1.48F, -0.62F),
                  {side * 0.16F, 1.58F, -0.58F},
                  {side * 0.07F, 1.50F, -0.56F}},
                 coat);
    add_triangle(body,
                 {glm::vec3(side * 0.03F, 1.50F, -0.66F),
                  {side * 0.17F, 1.85F, -0.60F},
                  {side * 0.06F, 1.50F, -0.62F}},
                 dark);
  }
  // Diagonal legs swing together.
  const auto leg = [&](core::MeshData& mesh, float x, float z) {
    add_ellipsoid(mesh, {x, -0.10F, z}, {0.07F, 0.26F, 0.09F}, coat, coat);
    add_ellipsoid(mesh, {x, -0.50F, z}, {0.04F, 0.34F, 0.045F}, coat, dark);
  };
  for (std::size_t pair = 1; pair < kParts; ++pair) {
    const float side = pair == 1 ? 1.0F : -1.0F;
    leg(parts[pair].mesh, side * 0.12F, -0.38F);
    leg(parts[pair].mesh, -side * 0.12F, 0.38F);
    parts[pair].joint = {0, 0.84F, 0};
    parts[pair].swing = 0.20F;
  }
  return parts;
}

std::array<Part, kParts> bird() {
  const glm::vec3 back(0.035F, 0.035F, 0.045F), breast(0.30F, 0.28F, 0.25F);
  std::array<Part, kParts> parts;
  add_ellipsoid(parts[0].mesh, {0, 0, 0}, {0.07F, 0.07F, 0.19F}, back, breast);
  add_ellipsoid(parts[0].mesh, {0, 0.05F, -0.20F}, {0.05F, 0.05F, 0.07F}, back, breast);
  add_triangle(parts[0].mesh, {glm::vec3(0, 0, 0.1F), {-0.09F, 0, 0.36F}, {0.09F, 0, 0.36F}}, back);
  for (std::size_t wing = 1; wing < kParts; ++wing) {
    const float side = wing == 1 ? 1.0F : -1.0F;
    core::MeshData& mesh = parts[wing].mesh;
    add_triangle(mesh, {glm::vec3(0, 0, -0.11F), {side * 0.30F, 0, -0.13F}, {0, 0, 0.13F}}, back);
    add_triangle(
        mesh, {glm::vec3(side * 0.30F, 0, -0.13F), {side * 0.58F, 0, 0.08F}, {0, 0, 0.13F}}, back);
    parts[wing].joint = {side * 0.05F, 0.03F, 0};
    parts[wing].axis = {0, 0, 1};
    parts[wing].swing = 0.75F;
  }
  return parts;
}

std::array<Part, kParts> fish() {
  const glm::vec3 back(0.10F, 0.12F, 0.10F), belly(0.50F, 0.50F, 0.44F);
  std::array<Part, kParts> parts;
  add_ellipsoid(parts[0].mesh, {0, 0, -0.04F}, {0.045F, 0.09F, 0.21F}, back, belly);
  add_triangle(parts[1].mesh, {glm::vec3(0, 0, 0), {0, 0.10F, 0.17F}, {0, -0.10F, 0.17F}}, back);
  parts[1].joint = {0, 0, 0.13F};
  parts[1].axis = {0, 1, 0};
  parts[1].swing = 0.6F;
  return parts;
}

// Returns the parts of a creature. Unused parts have no triangles.
std::array<Part, kParts> parts_of(Kind kind) {
  return kind == Kind::kDeer ? deer() : kind == Kind::kBird ? bird() : fish();
}

}  // namespace

core::Result<void> Scenery::open(app::Session& session) {
  scene::Scene& scene = session.scene();
  clear_sky_ = scene.world().sky;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    shapes_[kind] = parts_of(static_cast<Kind>(kind));
    for (std::size_t part = 0; part < kParts; ++part) {
      if (shapes_[kind][part].mesh.indices.empty()) continue;
      const auto mesh = scene.assets().add_mesh(shapes_[kind][part].mesh, "creature");
      if (!mesh) return tl::unexpected(mesh.error());
      meshes_[kind][part] = *mesh;
    }
  }
  ecs::World& world = scene.entities();
  smoke_ = scene::spawn_emitter(world, {.kind = beacon_smoke(), .visible = false}, {});
  glow_ = scene::spawn_emitter(world, {.kind = scene::sparks(), .visible = false}, {});
  beacon_light_ = scene::spawn_light(
      world, {.colour = kEmber, .intensity = 30, .range_m = 60, .visible = false}, {});
  rain_ = scene::spawn_emitter(world, {.kind = scene::rain(), .visible = false}, {});
  snow_ = scene::spawn_emitter(world, {.kind = scene::snow(), .visible = false}, {});
  lantern_ = scene::spawn_light(
      world, {.colour = {1.0F, 0.78F, 0.45F}, .intensity = 3, .range_m = 24, .visible = false}, {});
  return {};
}

void Scenery::update(app::Session& session, const Play& play, double share, double hour) {
  ++frame_;
  scene::Scene& scene = session.scene();
  update_creatures(scene, play, share);
  update_fires(scene, play);
  update_beacon(scene, play);
  update_falling(scene, play);
  update_weather(session, play, hour);
  const core::CameraPose eyes = play.walker().eyes(share);
  scene.entities().get<scene::Transform>(lantern_)->position =
      position_at_offset(eyes.position, 0.6 * glm::dvec3(core::forward_of(eyes)), play.block_m());
  scene.entities().get<scene::PointLight>(lantern_)->visible = play.progress().lantern;
}

void Scenery::update_creatures(scene::Scene& scene, const Play& play, double share) {
  ecs::World& world = scene.entities();
  for (const Creature& c : play.creatures().all()) {
    const auto kind = static_cast<std::size_t>(c.kind);
    Shown& shown = creatures_[c.seed];
    const bool is_new = std::exchange(shown.frame, frame_) == 0;
    const core::WorldPosition at =
        position_at_offset(c.before, way_m(c.before, c.at, play.block_m()) * share, play.block_m());
    const glm::quat whole = turned(c.yaw, c.pitch);
    for (std::size_t i = 0; i < kParts; ++i) {
      const Part& part = shapes_[kind][i];
      if (part.mesh.indices.empty()) continue;
      const float calm = c.kind == Kind::kDeer ? static_cast<float>(std::min(c.pace / 2, 2.2)) : 1;
      const float side = i == 1 ? 1.0F : -1.0F;
      const float angle = calm * part.swing * side * std::sin(static_cast<float>(c.beat));
      const glm::quat swung = whole * glm::angleAxis(angle, part.axis);
      scene::Transform place{position_at_offset(at, glm::dvec3(whole * part.joint), play.block_m()),
                             swung, glm::vec3(1.0F)};
      if (is_new) {
        shown.parts[i] = scene::spawn(world, {.mesh = meshes_[kind][i]}, place);
      } else if (auto* there = world.get<scene::Transform>(shown.parts[i])) {
        *there = place;
      }
    }
  }
  remove_gone(creatures_, world);
}

// Removes those that are not in this frame.
void Scenery::remove_gone(ShownByKey& shown, ecs::World& world) const {
  std::erase_if(shown, [&](const auto& entry) {
    const bool gone = entry.second.frame != frame_;
    if (gone) world.destroy(entry.second.parts);
    return gone;
  });
}

void Scenery::update_fires(scene::Scene& scene, const Play& play) {
  ecs::World& world = scene.entities();
  const double time_s = play.progress().time_s;
  for (const Fire& fire : play.progress().fires) {
    if (fire.until_s < time_s) continue;
    Shown& shown = fires_[name_of_place(fire.at)];
    if (std::exchange(shown.frame, frame_) == 0) {
      shown.parts = {
          scene::spawn_emitter(world, {.kind = scene::fire()}, {.position = fire.at}),
          scene::spawn_emitter(world, {.kind = scene::smoke()}, {.position = raised(fire.at, 0.6)}),
          scene::spawn_light(world, {.colour = kEmber, .intensity = 5, .range_m = 22},
                             {.position = raised(fire.at, 0.7)})};
    }
    // The fire flickers, and dims in its last seconds.
    const auto left = static_cast<float>(std::clamp((fire.until_s - time_s) / 30, 0.2, 1.0));
    const auto flicker =
        static_cast<float>(0.85 + 0.15 * std::sin(time_s * 11) * std::sin(time_s * 7.3));
    world.get<scene::PointLight>(shown.parts[2])->intensity = 5 * left * flicker;
  }
  remove_gone(fires_, world);
}

// Marks the next cairn with smoke by day and light by night.
void Scenery::update_beacon(scene::Scene& scene, const Play& play) {
  const auto next = play.next_cairn();
  const core::WorldPosition at =
      next ? raised(play.route().cairns[*next], kBeaconM) : core::WorldPosition();
  const bool night = play.is_night();
  for (const ecs::Entity entity : {smoke_, glow_, beacon_light_})
    scene.entities().get<scene::Transform>(entity)->position = at;
  scene.entities().get<scene::ParticleEmitter>(smoke_)->visible = next && !night;
  scene.entities().get<scene::ParticleEmitter>(glow_)->visible = next && night;
  scene.entities().get<scene::PointLight>(beacon_light_)->visible = next && night;
}

void Scenery::take_away(const Falling& tree, scene::Scene& scene) {
  scene.entities().destroy(std::array{tree.entity});
  scene.assets().remove_mesh(tree.mesh);
}

void Scenery::update_falling(scene::Scene& scene, const Play& play) {
  std::erase_if(falling_, [&](const Falling& tree) {
    const double age_s = play.progress().time_s - tree.since_s;
    const double share = std::clamp(age_s / kFallS, 0.0, 1.0);
    const auto angle = static_cast<float>(1.5 * share * share * share);
    const glm::vec3 axis(static_cast<float>(std::cos(tree.yaw)), 0,
                         static_cast<float>(std::sin(tree.yaw)));
    if (auto* there = scene.entities().get<scene::Transform>(tree.entity))
      there->rotation = glm::angleAxis(-angle, axis);
    const bool gone = age_s > kFallS + kLiesS || age_s < 0;
    if (gone) take_away(tree, scene);
    if (age_s > kFallS + kLiesS - 1 && !gone)
      scene.entities().get<scene::Object>(tree.entity)->visible = false;
    return gone;
  });
}

void Scenery::update_weather(app::Session& session, const Play& play, double hour) {
  const Weather weather = play.weather();
  world::Sky sky = clear_sky_;
  sky.start_hour = std::fmod(hour - session.now_s() / sky.day_length_s * 24, 24.0) + 24;
  sky.start_hour = std::fmod(sky.start_hour, 24.0);
  sky.cloud_cover = weather.clouds;
  sky.visibility_m =
      std::exp(std::lerp(std::log(clear_sky_.visibility_m), std::log(150.0), weather.fog));
  sky.sun_colour *= static_cast<float>(1 - 0.55 * std::max(weather.clouds - 0.5, 0.0));
  // Eyes adapt to the night.
  sky.exposure *= 1 + kNightEyes * std::clamp((std::abs(hour - 12) - kDuskH) / 1.5, 0.0, 1.0);
  (void)session.scene().set_sky(sky);
  scene::Scene& scene = session.scene();
  const bool cold = play.progress().feet.local.y > kSnowLineM;
  const auto wet = static_cast<float>(weather.wet);
  const glm::vec3 wind(weather.wind);
  const auto fall = [&](ecs::Entity entity, render::ParticleKind kind, bool here) {
    auto* emitter = scene.entities().get<scene::ParticleEmitter>(entity);
    emitter->visible = here && wet > 0.02F;
    kind.first_colour.w *= wet;
    kind.last_colour.w *= wet;
    emitter->kind = kind;
  };
  fall(rain_, scene::rain(0.3F * wind), !cold);
  fall(snow_, scene::snow(0.3F * wind), cold);
}

void Scenery::tell(app::Session& session, const Happening& happening, const Play& play) {
  if (happening.kind != Happening::Kind::kFelled || !happening.tree) return;
  scene::Scene& scene = session.scene();
  const models::ModelType& type = play.registry()[happening.tree->model];
  const auto mesh = scene.assets().add_model(type.name(), happening.tree->parameters, 0, 2);
  if (!mesh) return;
  Falling tree;
  tree.yaw = play.walker().yaw();
  tree.since_s = play.progress().time_s;
  tree.mesh = *mesh;
  tree.entity = scene::spawn(scene.entities(), {.mesh = *mesh}, {.position = happening.at});
  falling_.push_back(tree);
}

void Scenery::clear(app::Session& session) {
  ecs::World& world = session.scene().entities();
  ++frame_;
  remove_gone(creatures_, world);
  remove_gone(fires_, world);
  for (const Falling& tree : falling_)
    take_away(tree, session.scene());
  for (const ecs::Entity entity : {smoke_, glow_, rain_, snow_})
    world.get<scene::ParticleEmitter>(entity)->visible = false;
  for (const ecs::Entity entity : {beacon_light_, lantern_})
    world.get<scene::PointLight>(entity)->visible = false;
  (void)session.scene().set_sky(clear_sky_);
  falling_.clear();
}

}  // namespace cairns
