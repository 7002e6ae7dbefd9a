#include "engine/visibility/frustum.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/core/assert.hpp"

namespace psygen::visibility {

Frustum make_frustum(const glm::mat4& view_projection) {
  const glm::mat4 rows = glm::transpose(view_projection);
  // Clip space keeps −w <= x <= w, −w <= y <= w and, because depth is reversed, z <= w at the near
  // plane.
  Frustum frustum{{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                   rows[3] - rows[2]}};
  for (glm::vec4& plane : frustum.planes)
    plane /= glm::length(glm::vec3(plane.x, plane.y, plane.z));
  return frustum;
}

namespace {

// Four floats in one register (an extension of GCC and Clang).
using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;

Float4 absolute(Float4 v) {
  return v < 0 ? -v : v;
}

// A plane, split by the sign of its normal's coordinates. The positive part multiplies the largest
// coordinates of a box, the negative part the smallest: together they select the corner that is
// furthest inside.
struct SplitPlane {
  glm::vec3 positive, negative;
  float offset;

  explicit SplitPlane(const glm::vec4& plane)
      : positive(glm::max(glm::vec3(plane), 0.0F)),
        negative(glm::min(glm::vec3(plane), 0.0F)),
        offset(plane.w) {}
};

// Four boxes side by side.
struct Boxes4 {
  Float4 min[3], max[3];

  explicit Boxes4(const core::Bounds* boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] =
          Float4{boxes[0].min[axis], boxes[1].min[axis], boxes[2].min[axis], boxes[3].min[axis]};
      max[axis] =
          Float4{boxes[0].max[axis], boxes[1].max[axis], boxes[2].max[axis], boxes[3].max[axis]};
    }
  }

  Float4 limit() const {
    return -1e-6F * (absolute(min[0]) + absolute(min[1]) + absolute(min[2]) + absolute(max[0]) +
                     absolute(max[1]) + absolute(max[2]));
  }

  // −1 for each box outside the plane, else 0.
  Int4 miss(const SplitPlane& plane, Float4 limit) const {
    return (plane.positive.x * max[0] + plane.negative.x * min[0]) +
               (plane.positive.y * max[1] + plane.negative.y * min[1]) +
               (plane.positive.z * max[2] + plane.negative.z * min[2]) + plane.offset <
           limit;
  }
};

}  // namespace

void intersects(const Frustum& frustum, std::span<const core::Bounds> boxes,
                std::span<std::uint8_t> in_view) {
  PSYGEN_ASSERT(boxes.size() == in_view.size(), "in_view needs one element per box");
  const SplitPlane planes[5] = {SplitPlane(frustum.planes[0]), SplitPlane(frustum.planes[1]),
                                SplitPlane(frustum.planes[2]), SplitPlane(frustum.planes[3]),
                                SplitPlane(frustum.planes[4])};
  std::size_t i = 0;
  for (; i + 4 <= boxes.size(); i += 4) {
    const Boxes4 four(&boxes[i]);
    const Float4 limit = four.limit();
    Int4 missed{};
    for (const SplitPlane& plane : planes)
      missed |= four.miss(plane, limit);
    for (int k = 0; k < 4; ++k)
      in_view[i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(1 + missed[k]);
  }
  for (; i < boxes.size(); ++i)
    in_view[i] = intersects(frustum, boxes[i]) ? 1 : 0;
}

}  // namespace psygen::visibility
