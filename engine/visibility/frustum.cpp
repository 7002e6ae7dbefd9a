#include "engine/visibility/frustum.hpp"

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

void intersects(const Frustum& frustum, std::span<const core::Bounds> boxes,
                std::span<std::uint8_t> in_view) {
  PSYGEN_ASSERT(boxes.size() == in_view.size(), "there is one answer for each box");
  for (std::size_t i = 0; i < boxes.size(); ++i)
    in_view[i] = intersects(frustum, boxes[i]) ? 1 : 0;
}

}  // namespace psygen::visibility
