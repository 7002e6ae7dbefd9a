#include "engine/physics/object_bodies.hpp"

#include <utility>

#include "engine/physics/shapes.hpp"
#include "engine/physics/types.hpp"

namespace psygen::physics {
namespace {

constexpr double kObjectFriction = 0.8;

}  // namespace

query::ObjectId object_of(const btCollisionObject& body) {
  if (body.getUserIndex2() != kObjects) return {};
  return {static_cast<std::uint32_t>(body.getUserIndex()),
          static_cast<std::uint32_t>(body.getUserIndex3())};
}

ObjectBodies::ObjectBodies(btDynamicsWorld& bullet, const query::World& query,
                           const Terrain& terrain, Wake wake)
    : bullet_(bullet), query_(query), terrain_(terrain), wake_(std::move(wake)) {}

ObjectBodies::~ObjectBodies() {
  for (const auto& [id, body] : bodies_)
    bullet_.removeRigidBody(body->rigid.get());
}

btTransform ObjectBodies::pose_of(const query::PlacedObject& object) const {
  return btTransform(to_bt(object.rotation), terrain_.coordinates(object.position));
}

void ObjectBodies::add(query::ObjectId id, const query::PlacedObject& object, std::uint64_t step) {
  auto shape = make_shape(object.scaled->collider());
  if (!shape) return;  // query::Objects has the same limits
  auto body = std::make_unique<Body>();
  body->solid = object.scaled;
  body->shape = std::move(*shape);
  body->before = pose_of(object);
  body->motion = btDefaultMotionState(body->before);
  body->needed = step;
  btRigidBody::btRigidBodyConstructionInfo info(0, &body->motion, body->shape.get());
  info.m_friction = kObjectFriction;
  body->rigid = std::make_unique<btRigidBody>(info);
  btRigidBody& rigid = *body->rigid;
  rigid.setUserIndex(static_cast<int>(id.slot));
  rigid.setUserIndex2(kObjects);
  rigid.setUserIndex3(static_cast<int>(id.generation));
  rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  bullet_.addRigidBody(&rigid, kObjects, kBodies | kCharacters);
  bodies_.emplace(id, std::move(body));
}

ObjectBodies::Bodies::iterator ObjectBodies::erase(Bodies::iterator body) {
  wake_(*body->second->rigid);
  bullet_.removeRigidBody(body->second->rigid.get());
  return bodies_.erase(body);
}

// Bodies that rest on a kinematic one sleep only if it does.
void ObjectBodies::move(Body& body, const btTransform& pose, double dt) {
  btRigidBody& rigid = *body.rigid;
  body.before = rigid.getWorldTransform();
  body.carries = true;
  if (pose == body.before) {
    const bool was_moving =
        rigid.getLinearVelocity().length2() > 0 || rigid.getAngularVelocity().length2() > 0;
    rigid.forceActivationState(was_moving ? ACTIVE_TAG : ISLAND_SLEEPING);
    return;
  }
  if (!rigid.isActive()) wake_(rigid);
  rigid.forceActivationState(ACTIVE_TAG);
  body.motion.setWorldTransform(pose);
  rigid.setWorldTransform(pose);
  // Bullet derives the velocity from the displacement since the last step.
  body.carries = (pose.getOrigin() - body.before.getOrigin()).length() <= kMaxSpeed * dt;
  if (!body.carries) rigid.setInterpolationWorldTransform(pose);
  bullet_.updateSingleAabb(&rigid);
}

void ObjectBodies::follow(double dt) {
  const query::Objects* objects = query_.objects();
  for (auto body = bodies_.begin(); body != bodies_.end();) {
    const query::PlacedObject* object = objects == nullptr ? nullptr : objects->find(body->first);
    // A body of another size is rebuilt where it is needed.
    if (object == nullptr || object->scaled != body->second->solid) {
      body = erase(body);
      continue;
    }
    move(*body->second, pose_of(*object), dt);
    ++body;
  }
}

void ObjectBodies::need(const btVector3& low, const btVector3& high, std::uint64_t step) {
  const query::Objects* objects = query_.objects();
  if (objects == nullptr || objects->size() == 0) return;
  objects->near(terrain_.position((low + high) / 2), to_glm((high - low) / 2), near_);
  for (const query::ObjectId id : near_) {
    if (const auto there = bodies_.find(id); there != bodies_.end())
      there->second->needed = step;
    else
      add(id, *objects->find(id), step);
  }
}

void ObjectBodies::drop_idle(std::uint64_t step, std::uint32_t keep_steps) {
  for (auto body = bodies_.begin(); body != bodies_.end();)
    body = body->second->needed + keep_steps < step ? erase(body) : std::next(body);
}

void ObjectBodies::shift(const btVector3& by) {
  for (const auto& [id, body] : bodies_) {
    btTransform pose = body->rigid->getWorldTransform();
    pose.setOrigin(pose.getOrigin() - by);
    put(bullet_, *body->rigid, pose);
    body->motion.setWorldTransform(pose);
  }
}

btVector3 ObjectBodies::way_of(query::ObjectId object, const btVector3& point) const {
  const auto body = bodies_.find(object);
  if (body == bodies_.end() || !body->second->carries) return {0, 0, 0};
  const btTransform& now = body->second->rigid->getWorldTransform();
  return now * body->second->before.invXform(point) - point;
}

}  // namespace psygen::physics
