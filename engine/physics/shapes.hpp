// Conversions of vectors, rotations and colliders into Bullet's types, and poses. Internal to
// physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/collider.hpp"

namespace psygen::physics {

// Convert between GLM's types and Bullet's.
inline btVector3 to_bt(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
inline btVector3 to_bt(const glm::vec3& v) {
  return to_bt(glm::dvec3(v));
}
inline btQuaternion to_bt(const glm::dquat& q) {
  return {q.x, q.y, q.z, q.w};
}
inline glm::dvec3 to_glm(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
inline glm::dquat to_glm(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

// An upright pose at a point.
inline btTransform upright(const btVector3& place) {
  return btTransform(btQuaternion::getIdentity(), place);
}
// Moves a body to a pose at once, without a velocity.
inline void put(btCollisionWorld& bullet, btCollisionObject& body, const btTransform& pose) {
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
  if (body.getBroadphaseHandle() != nullptr) bullet.updateSingleAabb(&body);
}

// A shape with the parts that it points to.
struct OwnedShape {
  std::vector<std::unique_ptr<btCollisionShape>> parts;  // the last one is the whole
  double inner_m = 0;              // half of the thickness of the thickest part
  std::vector<btVector3> middles;  // a point inside each part, apart from the origin
  btCollisionShape* get() const { return parts.back().get(); }
};

// Makes the shape of a collider around its origin. Fails with kInvalidArgument for a collider
// without parts, values that are not finite, and sizes outside kMinSizeM … kMaxSizeM.
core::Result<OwnedShape> make_shape(const models::Collider& collider);

// One part and its pose, unchecked.
struct PlacedShape {
  std::unique_ptr<btCollisionShape> shape;
  btTransform place;
};
PlacedShape make_part(const models::Collider::Shape& shape);

}  // namespace psygen::physics
