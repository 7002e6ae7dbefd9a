#include "engine/physics/world_impl.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "engine/physics/impact.hpp"
#include "engine/physics/shapes.hpp"

namespace psygen::physics {
namespace {

// Limit of coordinates near the first moving body or character.
constexpr double kMaxFromOriginM = 4096;
// Terrain is loaded this much further than a body can move in a step.
constexpr double kMarginM = 2;

bool is_finite(const btVector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

btVector3 limited(const btVector3& v, double most) {
  const double length = v.length();
  return length > most ? btVector3(v * (most / length)) : v;
}

}  // namespace

bool is_within(const glm::dvec3& v, double most) {
  // False for NaN.
  return std::abs(v.x) <= most && std::abs(v.y) <= most && std::abs(v.z) <= most;
}

World::Impl::Impl(query::World& queries, const Settings& wanted)
    : query(queries), settings(wanted) {
  bullet.setGravity({0, -settings.gravity, 0});
  bullet.getDispatchInfo().m_deterministicOverlappingPairs = true;
  bullet.setForceUpdateAllAabbs(false);
}

World::Impl::~Impl() {
  for (auto& [number, body] : bodies)
    bullet.removeRigidBody(body.rigid.get());
}

World::Impl::Body* World::Impl::find(BodyId id) {
  const auto found = bodies.find(id.number);
  return found == bodies.end() ? nullptr : &found->second;
}

Character* World::Impl::find(CharacterId id) {
  const auto found = characters.find(id.number);
  return found == characters.end() ? nullptr : &found->second;
}

core::Result<btVector3> World::Impl::place(const core::WorldPosition& at, std::size_t others) {
  follow_world();
  const auto sound = query::checked(at, query.world().block_size_m());
  if (!sound) return tl::unexpected(sound.error());
  if (!query.world().contains(sound->block))
    return core::invalid_argument(
        fmt::format("block ({}, {}) is outside the world", sound->block.x, sound->block.z));
  const bool across = terrain.is_across_seam(sound->block);
  if (across && others > 0)
    return core::invalid_argument(
        fmt::format("block ({}, {}) lies across the seam of the endless world from the other "
                    "bodies and characters",
                    sound->block.x, sound->block.z));
  const btVector3 to = terrain.coordinates(*sound);
  const bool near = btVector3(to.x(), 0, to.z()).length() <= kMaxFromOriginM;
  if (!across && (near || count() > 1)) return to;
  move_origin(sound->block);
  return terrain.coordinates(*sound);
}

// The origin stays near the character with the lowest number, or else the body.
void World::Impl::shift_origin() {
  if (count() == 0) return;
  const btVector3 first = !characters.empty()
                              ? characters.begin()->second.feet()
                              : bodies.begin()->second.rigid->getCenterOfMassPosition();
  if (btVector3(first.x(), 0, first.z()).length() > kMaxFromOriginM)
    move_origin(terrain.position(first).block);
}

void World::Impl::move_origin(core::BlockCoord to) {
  const btVector3 by = terrain.coordinates({to, glm::dvec3(0)});
  // All objects move alike, so there are no new pairs to find.
  broadphase.m_deferedcollide = true;
  terrain.set_origin(to);
  shift(by);
  broadphase.m_deferedcollide = false;
}

void World::Impl::shift(const btVector3& by) {
  for (auto& [number, character] : characters)
    character.shift(by);
  objects.shift(by);
  for (auto& [number, body] : bodies) {
    btTransform transform = body.rigid->getWorldTransform();
    transform.setOrigin(transform.getOrigin() - by);
    put(bullet, *body.rigid, transform);
    btTransform target;
    body.motion.getWorldTransform(target);
    target.setOrigin(target.getOrigin() - by);
    body.motion.setWorldTransform(target);
  }
}

void World::Impl::follow_world() {
  const auto by = terrain.follow_world();
  if (!by) return;
  if (!by->isZero()) shift(*by);
  for (auto& [number, character] : characters)
    character.teleport(character.feet());
  for (auto& [number, body] : bodies) {
    if (body.kind != Motion::kDynamic) continue;
    body.rigid->activate(true);
    body.before = body.rigid->getWorldTransform();
    lift_above_ground(body);
  }
}

void World::Impl::make_surroundings(double dt) {
  const auto need = [&](const btVector3& at, const btVector3& velocity, double reach_m) {
    const btVector3 to = at + velocity * dt;
    const double around = reach_m + kMarginM;
    btVector3 low = at, high = at;
    low.setMin(to);
    high.setMax(to);
    low -= btVector3(around, around, around);
    high += btVector3(around, around, around);
    terrain.need({low.x(), low.z()}, {high.x(), high.z()}, steps);
    objects.need(low, high, steps);
  };
  for (const auto& [number, character] : characters)
    need(character.feet(), character.velocity, character.reach_m());
  for (const auto& [number, body] : bodies)
    need(body.rigid->getCenterOfMassPosition(), body.rigid->getLinearVelocity(), body.reach_m);
}

void World::Impl::step(double dt) {
  ++steps;
  follow_world();
  shift_origin();
  sync_edits();
  objects.follow(dt);
  make_surroundings(dt);
  const bool has_water = settings.water_kg_m3 > 0 && world::has_water(query.world());
  for (auto& [number, character] : characters) {
    const btVector3& feet = character.feet();
    character.step(dt, settings.gravity, objects.way_of(character.floor(), feet),
                   has_water ? water_at(terrain, query.world(), feet) : WaterHere());
  }
  for (auto& [number, body] : bodies) {
    body.before = body.rigid->getWorldTransform();
    if (body.kind == Motion::kDynamic && has_water && body.rigid->isActive())
      float_body(*body.rigid, body.displacement,
                 water_at(terrain, query.world(), body.before.getOrigin()), settings.water_kg_m3,
                 settings.gravity, dt);
    if (body.kind != Motion::kKinematic) continue;
    // Bodies that rest on a kinematic one sleep only if it does.
    const bool moves = body.is_moved || body.rigid->getLinearVelocity().length2() > 0 ||
                       body.rigid->getAngularVelocity().length2() > 0;
    body.rigid->forceActivationState(moves ? ACTIVE_TAG : ISLAND_SLEEPING);
    body.is_moved = false;
  }
  bullet.stepSimulation(dt, 0);
  stop_at_impacts();
  for (auto& [number, body] : bodies)
    if (body.kind == Motion::kDynamic) lift_above_ground(body);
  terrain.drop_idle(steps, settings.keep_steps, settings.max_idle_blocks);
  objects.drop_idle(steps, settings.keep_steps);
}

core::Result<void> World::Impl::check_room() const {
  if (count() < settings.max_bodies) return {};
  return core::fail(core::ErrorCode::kOverBudget,
                    fmt::format("there are {} bodies and characters already, the limit of the "
                                "settings",
                                settings.max_bodies));
}

// Contacts are kept while both bodies sleep.
void World::Impl::wake_touching(const btCollisionObject& object) {
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& contact = *dispatcher.getManifoldByIndexInternal(i);
    const bool first = contact.getBody0() == &object;
    if (!first && contact.getBody1() != &object) continue;
    const btCollisionObject& touching = first ? *contact.getBody1() : *contact.getBody0();
    if (touching.getUserIndex2() != kBodies) continue;
    Body* other = find(BodyId{static_cast<std::uint32_t>(touching.getUserIndex())});
    if (other != nullptr && other->kind == Motion::kDynamic) other->rigid->activate(true);
  }
}

void World::Impl::sync_edits() {
  const Terrain::Changes changes = terrain.sync_edits();
  if (changes.blocks.empty()) return;
  for (auto& [number, body] : bodies) {
    const btVector3& at = body.rigid->getCenterOfMassPosition();
    const glm::dvec2 middle(at.x(), at.z());
    const double around = body.reach_m + kMarginM;
    if (body.kind == Motion::kDynamic && terrain.is_near(changes, middle - around, middle + around))
      body.rigid->activate(true);
  }
}

// Objects and kinematic bodies have moved before Bullet's step. All paths are those of Bullet, so
// two bodies stop where they meet.
void World::Impl::stop_at_impacts() {
  const auto path_of = [&](const btCollisionObject& object) {
    const btTransform& pose = object.getWorldTransform();
    const Body* body = object.getUserIndex2() == kBodies
                           ? find(BodyId{static_cast<std::uint32_t>(object.getUserIndex())})
                           : nullptr;
    return body != nullptr && body->kind == Motion::kDynamic ? Path::between(body->before, pose)
                                                             : Path{pose};
  };
  std::vector<std::pair<btRigidBody*, btTransform>> stopped;
  for (auto& [number, body] : bodies) {
    if (body.kind != Motion::kDynamic || !body.rigid->isActive()) continue;
    if (!is_finite(body.rigid->getWorldTransform().getOrigin())) continue;
    const Path path = path_of(*body.rigid);
    const Impact impact = first_impact(broadphase, *body.rigid, path, path_of);
    if (impact.share == 1) continue;
    btTransform pose = path.at(impact.share);
    pose.setOrigin(pose.getOrigin() + impact.push);
    stopped.emplace_back(body.rigid.get(), pose);
  }
  for (const auto& [rigid, pose] : stopped)
    put(bullet, *rigid, pose);
}

// Bullet finds contacts only at the end of a step, so fast bodies may be below the ground by then.
// Checks the path of the centre against the exact ground, and then the middle of each part.
void World::Impl::lift_above_ground(Body& body) {
  btRigidBody& rigid = *body.rigid;
  if (!rigid.isActive()) return;
  btTransform transform = rigid.getWorldTransform();
  btVector3 at = transform.getOrigin(), velocity = rigid.getLinearVelocity();
  const double inner = body.shape.inner_m;
  bool changed = false;
  if (!is_finite(at) || !is_finite(velocity) || !is_finite(rigid.getAngularVelocity())) {
    transform = btTransform(btQuaternion::getIdentity(), body.before.getOrigin());
    at = body.before.getOrigin();
    velocity = {0, 0, 0};
    rigid.setAngularVelocity({0, 0, 0});
    changed = true;
  }
  const auto stop_at = [&](const btVector3& normal) {
    velocity -= normal * std::min(velocity.dot(normal), btScalar(0));
    changed = true;
  };
  const btVector3 before = body.before.getOrigin(), way = at - before;
  if (way.length() > 0.5 * inner) {
    const auto hit = query.cast({.origin = terrain.position(before),
                                 .direction = to_glm(way),
                                 .longest_m = way.length(),
                                 .models = false,
                                 .objects = false});
    if (hit && hit->kind == query::HitKind::kGround && !hit->from_inside) {
      const btVector3 normal = to_bt(hit->normal);
      at = before + way.normalized() * hit->distance_m + normal * inner;
      stop_at(normal);
    }
  }
  if (const btVector3 in = terrain.inside(at, inner); in != at) {
    stop_at((in - at).normalized());
    at = in;
  }
  const models::GroundPoint ground = terrain.ground(at);
  if (at.y() < ground.height_m) {
    at.setY(ground.height_m + inner);
    stop_at(to_bt(ground.normal));
  }
  // Such parts keep their speed, for their contacts with the ground.
  for (const btVector3& middle : body.shape.middles) {
    const btVector3 part = at + transform.getBasis() * middle;
    const double depth_m = terrain.ground(part).height_m - part.y();
    if (depth_m <= 0) continue;
    at.setY(at.y() + depth_m);
    changed = true;
  }
  if (velocity.length() > kMaxSpeed) {
    velocity = limited(velocity, kMaxSpeed);
    changed = true;
  }
  if (!changed) return;
  transform.setOrigin(at);
  put(bullet, rigid, transform);
  rigid.setLinearVelocity(velocity);
  rigid.setInterpolationLinearVelocity(velocity);
  rigid.setAngularVelocity(limited(rigid.getAngularVelocity(), kMaxSpeed));
}

}  // namespace psygen::physics
