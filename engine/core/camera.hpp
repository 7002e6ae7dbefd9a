// A camera: its pose and its projection. Matrices are relative to the camera's position (the camera
// is the origin), so precision does not suffer far from the world's origin. Depth is reversed: 1 at
// the near plane, 0 infinitely far. Vulkan clip space (y down). Values and pure functions; not a
// controller (platform/fly_camera.hpp).
#pragma once

#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"

namespace psygen::core {

// yaw 0 looks along −Z; growing yaw turns right (to +X); growing pitch turns up. Radians.
struct CameraPose {
  WorldPosition position;
  double yaw = 0;
  double pitch = 0;
};

// Returns the direction of view as a unit vector.
inline glm::vec3 forward_of(const CameraPose& pose) {
  const double c = std::cos(pose.pitch);
  return {static_cast<float>(std::sin(pose.yaw) * c), static_cast<float>(std::sin(pose.pitch)),
          static_cast<float>(-std::cos(pose.yaw) * c)};
}

// A perspective without a far plane.
struct Projection {
  float vertical_fov = 0.9F;    // radians, in (0, π)
  float aspect = 16.0F / 9.0F;  // width / height
  float near_m = 0.2F;          // above 0
  // Pixels per radian in the middle of an image that is `height` pixels high.
  float pixels_per_radian(float height) const {
    return height * 0.5F / std::tan(vertical_fov * 0.5F);
  }
};

// Rotates world directions into view space (right, up, −forward).
inline glm::mat4 view_rotation(const CameraPose& pose) {
  const float sy = static_cast<float>(std::sin(pose.yaw)),
              cy = static_cast<float>(std::cos(pose.yaw));
  const float sp = static_cast<float>(std::sin(pose.pitch)),
              cp = static_cast<float>(std::cos(pose.pitch));
  const glm::vec3 right{cy, 0, sy};
  const glm::vec3 forward{sy * cp, sp, -cy * cp};
  const glm::vec3 up{-sy * sp, cp, cy * sp};
  glm::mat4 m(1.0F);
  for (int i = 0; i < 3; ++i) {
    m[i][0] = right[i];
    m[i][1] = up[i];
    m[i][2] = -forward[i];
  }
  return m;
}

// The projection of view space, for Vulkan: infinite, with reversed depth.
inline glm::mat4 projection_matrix(const Projection& p) {
  const float f = 1.0F / std::tan(p.vertical_fov * 0.5F);
  glm::mat4 m(0.0F);
  m[0][0] = f / p.aspect;
  m[1][1] = -f;
  m[2][3] = -1.0F;
  m[3][2] = p.near_m;
  return m;
}

// False for NaN, infinities, heights beyond ±10^7 m, local x or z beyond ±10^12 m and angles beyond
// ±10^9 rad. Such a pose must not reach the tick.
inline bool is_valid(const CameraPose& pose) {
  const auto ok = [](double v, double limit) { return std::isfinite(v) && std::abs(v) <= limit; };
  return ok(pose.position.local.x, 1e12) && ok(pose.position.local.y, 1e7) &&
         ok(pose.position.local.z, 1e12) && ok(pose.yaw, 1e9) && ok(pose.pitch, 1e9);
}

}  // namespace psygen::core
