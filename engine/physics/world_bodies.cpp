// The bodies of physics::World.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/physics/shapes.hpp"
#include "engine/physics/world_impl.hpp"

namespace psygen::physics {
namespace {

tl::unexpected<core::Error> no_body(BodyId id) {
  return core::invalid_argument(fmt::format("body {} does not exist", id.number));
}

core::Result<glm::dquat> checked_rotation(const glm::dquat& q) {
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 1e-6 && length < 1e6))
    return core::invalid_argument("the rotation is not a finite quaternion above zero");
  return glm::dquat(q.w / length, q.x / length, q.y / length, q.z / length);
}

core::Result<void> check_speeds(const glm::dvec3& velocity, const glm::dvec3& spin) {
  if (is_within(velocity, kMaxSpeed) && is_within(spin, kMaxSpeed)) return {};
  return core::invalid_argument(
      fmt::format("velocity and spin must be finite, and at most {} along each axis", kMaxSpeed));
}

core::Result<void> check(const BodySettings& s) {
  if (auto speeds = check_speeds(s.velocity, s.spin); !speeds) return speeds;
  if (s.motion == Motion::kDynamic && !(s.mass_kg > 0 && s.mass_kg <= 1e9))
    return core::invalid_argument(
        fmt::format("the mass must be above 0 and at most 10^9 kg, not {}", s.mass_kg));
  if (!(s.friction >= 0 && s.friction <= 10))
    return core::invalid_argument(fmt::format("the friction {} is not in 0 … 10", s.friction));
  if (!(s.restitution >= 0 && s.restitution <= 1))
    return core::invalid_argument(fmt::format("the restitution {} is not in 0 … 1", s.restitution));
  return {};
}

}  // namespace

core::Result<BodyId> World::add(const BodySettings& s) {
  if (auto sound = check(s); !sound) return tl::unexpected(sound.error());
  const auto rotation = checked_rotation(s.rotation);
  if (!rotation) return tl::unexpected(rotation.error());
  auto shape = make_shape(s.shape);
  if (!shape) return tl::unexpected(shape.error());
  if (auto room = impl_->check_room(); !room) return tl::unexpected(room.error());
  const auto at = impl_->place(s.position, impl_->count());
  if (!at) return tl::unexpected(at.error());

  const std::uint32_t number = ++impl_->last_number;
  Impl::Body& body = impl_->bodies[number];
  body.shape = std::move(*shape);
  body.kind = s.motion;
  btVector3 centre;
  btScalar radius;
  body.shape.get()->getBoundingSphere(centre, radius);
  body.reach_m = centre.length() + radius;
  body.displacement = displacement_of(s.shape);
  body.before = btTransform(to_bt(*rotation), *at);
  body.motion = btDefaultMotionState(body.before);
  const bool dynamic = s.motion == Motion::kDynamic;
  btVector3 inertia(0, 0, 0);
  if (dynamic) body.shape.get()->calculateLocalInertia(s.mass_kg, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(dynamic ? s.mass_kg : 0, &body.motion,
                                                body.shape.get(), inertia);
  info.m_friction = s.friction;
  info.m_restitution = s.restitution;
  body.rigid = std::make_unique<btRigidBody>(info);
  btRigidBody& rigid = *body.rigid;
  rigid.setUserIndex(static_cast<int>(number));
  rigid.setUserIndex2(kBodies);
  if (dynamic) {
    rigid.setLinearVelocity(to_bt(s.velocity));
    rigid.setAngularVelocity(to_bt(s.spin));
  } else {
    rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body.is_moved = true;
  }
  impl_->bullet.addRigidBody(&rigid, kBodies, kGround | kModels | kBodies | kCharacters | kObjects);
  return BodyId{number};
}

core::Result<void> World::remove(BodyId id) {
  const auto found = impl_->bodies.find(id.number);
  if (found == impl_->bodies.end()) return no_body(id);
  impl_->wake_touching(*found->second.rigid);
  impl_->bullet.removeRigidBody(found->second.rigid.get());
  impl_->bodies.erase(found);
  return {};
}

core::Result<BodyState> World::state(BodyId id) const {
  impl_->follow_world();
  const Impl::Body* body = impl_->find(id);
  if (body == nullptr) return no_body(id);
  const btRigidBody& rigid = *body->rigid;
  return BodyState{impl_->terrain.position(rigid.getCenterOfMassPosition()),
                   to_glm(rigid.getOrientation()), to_glm(rigid.getLinearVelocity()),
                   to_glm(rigid.getAngularVelocity()), !rigid.isActive()};
}

core::Result<void> World::set_pose(BodyId id, const core::WorldPosition& position,
                                   const glm::dquat& rotation) {
  Impl::Body* body = impl_->find(id);
  if (body == nullptr) return no_body(id);
  const auto turn = checked_rotation(rotation);
  if (!turn) return tl::unexpected(turn.error());
  const auto at = impl_->place(position, impl_->count() - 1);
  if (!at) return tl::unexpected(at.error());
  btRigidBody& rigid = *body->rigid;
  if (!rigid.isActive()) impl_->wake_touching(rigid);
  const btTransform pose(to_bt(*turn), *at);
  body->motion.setWorldTransform(pose);
  body->is_moved = true;
  const double way_m = (*at - rigid.getCenterOfMassPosition()).length();
  if (body->kind == Motion::kKinematic && way_m <= impl_->query.world().block_size_m()) return {};
  put(impl_->bullet, rigid, pose);
  rigid.activate(true);
  return {};
}

core::Result<void> World::set_velocity(BodyId id, const glm::dvec3& velocity,
                                       const glm::dvec3& spin) {
  Impl::Body* body = impl_->find(id);
  if (body == nullptr) return no_body(id);
  if (body->kind != Motion::kDynamic)
    return core::invalid_argument("only dynamic bodies have a velocity to set");
  if (auto speeds = check_speeds(velocity, spin); !speeds) return speeds;
  body->rigid->setLinearVelocity(to_bt(velocity));
  body->rigid->setAngularVelocity(to_bt(spin));
  body->rigid->activate(true);
  return {};
}

core::Result<void> World::push(BodyId id, const glm::dvec3& impulse) {
  Impl::Body* body = impl_->find(id);
  if (body == nullptr) return no_body(id);
  if (body->kind != Motion::kDynamic)
    return core::invalid_argument("only dynamic bodies can be pushed");
  const double mass = 1 / body->rigid->getInvMass();
  if (!is_within(impulse / mass, kMaxSpeed))
    return core::invalid_argument(
        fmt::format("an impulse must be finite and change the speed by at most {} m/s", kMaxSpeed));
  body->rigid->applyCentralImpulse(to_bt(impulse));
  body->rigid->activate(true);
  return {};
}

}  // namespace psygen::physics
