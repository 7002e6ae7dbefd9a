// Conversions between GLM's types and Bullet's. Internal to physics.
#pragma once

#include <LinearMath/btQuaternion.h>
#include <LinearMath/btVector3.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace psygen::physics {

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

}  // namespace psygen::physics
