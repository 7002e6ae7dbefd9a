#include "engine/physics/capsule_mover.hpp"

#include "engine/physics/shapes.hpp"
#include "engine/physics/terrain.hpp"

namespace psygen::physics {
namespace {

constexpr int kObstacles = kModels | kObjects | kBodies | kCharacters;

// A callback of Bullet for objects that stop the capsule.
template <class Callback>
struct ObstacleCallback : Callback {
  explicit ObstacleCallback(const CapsuleMover& capsule_mover) : mover(capsule_mover) {
    this->m_collisionFilterGroup = kCharacters;
    this->m_collisionFilterMask = kObstacles;
  }
  bool needsCollision(btBroadphaseProxy* proxy) const override {
    return Callback::needsCollision(proxy) &&
           mover.stops(*static_cast<const btCollisionObject*>(proxy->m_clientObject));
  }
  const CapsuleMover& mover;
};

struct SweepCallback : ObstacleCallback<btCollisionWorld::ConvexResultCallback> {
  SweepCallback(const CapsuleMover& capsule_mover, const btVector3& towards)
      : ObstacleCallback(capsule_mover), direction(towards) {}
  btScalar addSingleResult(btCollisionWorld::LocalConvexResult& result,
                           bool normal_in_world) override {
    const btVector3 n =
        normal_in_world
            ? result.m_hitNormalLocal
            : result.m_hitCollisionObject->getWorldTransform().getBasis() * result.m_hitNormalLocal;
    if (n.dot(direction) >= -1e-9) return m_closestHitFraction;
    m_closestHitFraction = result.m_hitFraction;
    found = {result.m_hitFraction, n, true, result.m_hitCollisionObject};
    return result.m_hitFraction;
  }
  btVector3 direction;
  Sweep found;
};

struct DeepestContact : ObstacleCallback<btCollisionWorld::ContactResultCallback> {
  DeepestContact(const CapsuleMover& capsule_mover, const btCollisionObject& object)
      : ObstacleCallback(capsule_mover), probe(object) {}
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    if (point.getDistance() >= depth) return 0;
    depth = point.getDistance();
    normal = a->getCollisionObject() == &probe ? point.m_normalWorldOnB : -point.m_normalWorldOnB;
    return 0;
  }
  const btCollisionObject& probe;
  btScalar depth = 0;
  btVector3 normal{0, 0, 0};
};

}  // namespace

bool CapsuleMover::stops(const btCollisionObject& other) const {
  if (&other == &self_) return false;
  const btRigidBody* body = btRigidBody::upcast(&other);
  return body == nullptr || body->getInvMass() == 0 || body->getInvMass() * mass_kg_ <= 1;
}

Sweep CapsuleMover::sweep(const btVector3& from, const btVector3& to) const {
  if ((to - from).length2() < 1e-18) return {};
  SweepCallback callback(*this, (to - from).normalized());
  world_.convexSweepTest(&capsule_, upright(from), upright(to), callback, 0);
  return callback.found;
}

btVector3 CapsuleMover::pushed_out(const btVector3& place) const {
  btVector3 free = place;
  btCollisionObject probe;
  probe.setCollisionShape(const_cast<btConvexShape*>(&capsule_));  // contactTest() only reads it
  for (int i = 0; i < 4; ++i) {
    probe.setWorldTransform(upright(free));
    DeepestContact contact(*this, probe);
    const_cast<btCollisionWorld&>(world_).contactTest(&probe, contact);
    if (contact.depth > -kSkinM) break;
    free -= contact.normal * (contact.depth + 0.5 * kSkinM);
  }
  return free;
}

}  // namespace psygen::physics
