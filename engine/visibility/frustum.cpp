#include "engine/visibility/frustum.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/core/assert.hpp"

namespace psygen::visibility {

Frustum make_frustum(const glm::mat4& view_projection) {
  const glm::mat4 rows = glm::transpose(view_projection);
  // Clip space keeps −w <= x <= w, −w <= y <= w and, depth being reversed, z <= w at the near
  // plane.
  Frustum frustum{{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                   rows[3] - rows[2]}};
  for (glm::vec4& plane : frustum.planes)
    plane /= glm::length(glm::vec3(plane.x, plane.y, plane.z));
  return frustum;
}

namespace {

// Four floats that are computed with at once (an extension of GCC and Clang).
using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;

// The first four planes side by side. A component of a normal counts for the largest coordinate of
// a box where it is positive, for the smallest where it is negative: that is the corner which lies
// furthest inside.
struct Planes4 {
  Float4 positive[3], negative[3], offset;

  explicit Planes4(const Frustum& frustum) {
    for (int k = 0; k < 4; ++k) {
      const glm::vec4& plane = frustum.planes[static_cast<std::size_t>(k)];
      for (int axis = 0; axis < 3; ++axis) {
        positive[axis][k] = std::max(plane[axis], 0.0F);
        negative[axis][k] = std::min(plane[axis], 0.0F);
      }
      offset[k] = plane.w;
    }
  }

  bool are_missed(const core::Bounds& box, float limit) const {
    const Float4 distance = (positive[0] * box.max.x + negative[0] * box.min.x) +
                            (positive[1] * box.max.y + negative[1] * box.min.y) +
                            (positive[2] * box.max.z + negative[2] * box.min.z) + offset;
    const Int4 outside = distance < limit;
    return (outside[0] | outside[1] | outside[2] | outside[3]) != 0;
  }
};

float distance_to(const glm::vec4& plane, const core::Bounds& box) {
  return plane.x * (plane.x > 0 ? box.max.x : box.min.x) +
         plane.y * (plane.y > 0 ? box.max.y : box.min.y) +
         plane.z * (plane.z > 0 ? box.max.z : box.min.z) + plane.w;
}

}  // namespace

void intersects(const Frustum& frustum, std::span<const core::Bounds> boxes,
                std::span<std::uint8_t> in_view) {
  PSYGEN_ASSERT(boxes.size() == in_view.size(), "there is one answer for each box");
  const Planes4 sides(frustum);
  const glm::vec4 near = frustum.planes[4];
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const core::Bounds box = boxes[i];
    const float limit = -rounding_slack(box);
    in_view[i] = sides.are_missed(box, limit) || distance_to(near, box) < limit ? 0 : 1;
  }
}

}  // namespace psygen::visibility
