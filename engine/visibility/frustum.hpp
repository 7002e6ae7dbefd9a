// The view frustum without a far plane, and conservative tests of boxes against it. Everything is
// relative to the camera, which is the origin (core/camera.hpp). Not an occlusion test: a box
// behind a mountain is in view here. Values only; usable from any thread. Each box costs five plane
// tests.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "engine/core/coordinates.hpp"

namespace psygen::visibility {

// Five planes (normal of unit length, offset in metres) that point inwards: left, right, bottom,
// top, near. A point p is inside when dot(normal, p) + offset >= 0 for all of them.
struct Frustum {
  std::array<glm::vec4, 5> planes{};
};

// The frustum of projection · view with infinite reversed depth (core::projection_matrix ·
// core::view_rotation). The far plane at infinity is left out. (Gribb and Hartmann 2001.)
Frustum make_frustum(const glm::mat4& view_projection);

// An upper bound, in metres, of the rounding errors of distances between the box and a plane.
inline float rounding_slack(const core::Bounds& box) {
  return 1e-6F * (std::abs(box.min.x) + std::abs(box.min.y) + std::abs(box.min.z) +
                  std::abs(box.max.x) + std::abs(box.max.y) + std::abs(box.max.z));
}

// Returns false only if the whole box lies outside one plane. A box near a corner of the frustum
// may count as intersecting although it does not. Rounding errors make the result true.
inline bool intersects(const Frustum& frustum, const core::Bounds& box) {
  const float slack = rounding_slack(box);
  for (const glm::vec4& plane : frustum.planes) {
    // The corner that is furthest inside.
    const float x = plane.x > 0 ? box.max.x : box.min.x;
    const float y = plane.y > 0 ? box.max.y : box.min.y;
    const float z = plane.z > 0 ? box.max.z : box.min.z;
    if (plane.x * x + plane.y * y + plane.z * z + plane.w < -slack) return false;
  }
  return true;
}

// Tests many boxes at once, faster: in_view[i] = 1 or 0. Both spans have the same length.
void intersects(const Frustum& frustum, std::span<const core::Bounds> boxes,
                std::span<std::uint8_t> in_view);

}  // namespace psygen::visibility
