// The view frustum without a far plane, and conservative tests of boxes against it. Everything is
// relative to the camera, which is the origin (core/camera.hpp). Not an occlusion test: a box
// behind a mountain is in view here. Values only; usable from any thread.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "engine/core/coordinates.hpp"

namespace psygen::visibility {

// Planes (normal of unit length, offset in metres) that point inwards: left, right, bottom, top,
// near. A point p is inside where dot(normal, p) + offset >= 0 for all of them.
struct Frustum {
  std::array<glm::vec4, 5> planes{};
};

// From projection · view with infinite reversed depth (core::projection_matrix ·
// core::view_rotation). The far plane at infinity is left out. (Gribb and Hartmann 2001.)
Frustum make_frustum(const glm::mat4& view_projection);

// False only if the whole box lies outside one plane; boxes near a corner of the frustum may be
// said to intersect though they do not. Rounding is on the side of true.
inline bool intersects(const Frustum& frustum, const core::Bounds& box) {
  const glm::vec3 c = box.center(), h = box.half_extent();
  // Three roundings of a sum of terms this large, with room.
  const float slack = 1e-6F * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z) + h.x + h.y + h.z);
  float nearest = slack;
  for (const glm::vec4& p : frustum.planes) {
    const float reach = std::abs(p.x) * h.x + std::abs(p.y) * h.y + std::abs(p.z) * h.z;
    const float distance = p.x * c.x + p.y * c.y + p.z * c.z + p.w + reach + slack;
    nearest = distance < nearest ? distance : nearest;
  }
  return nearest >= 0;
}

// The same for many boxes: in_view[i] = 1 or 0. Both spans have one length.
void intersects(const Frustum& frustum, std::span<const core::Bounds> boxes,
                std::span<std::uint8_t> in_view);

}  // namespace psygen::visibility
