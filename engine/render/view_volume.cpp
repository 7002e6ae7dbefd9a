#include "engine/render/view_volume.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace psygen::render {

namespace {

constexpr float kLargestGrid = 127.0F;  // cells (core::TerrainVertex)
constexpr float kSlackShare = 1e-6F;    // slack for rounding, relative to a box's coordinates

}  // namespace

ViewVolume view_volume(const glm::mat4& clip_from_camera) {
  const glm::mat4 rows = glm::transpose(clip_from_camera);
  ViewVolume volume;
  volume.planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                   rows[3] - rows[2]};
  for (glm::vec4& plane : volume.planes)
    plane /= glm::length(glm::vec3(plane));
  return volume;
}

bool in_view(const ViewVolume& volume, const core::Bounds& box) {
  const float slack =
      kSlackShare * (std::abs(box.min.x) + std::abs(box.min.y) + std::abs(box.min.z) +
                     std::abs(box.max.x) + std::abs(box.max.y) + std::abs(box.max.z));
  for (const glm::vec4& plane : volume.planes) {
    const float x = plane.x > 0 ? box.max.x : box.min.x;
    const float y = plane.y > 0 ? box.max.y : box.min.y;
    const float z = plane.z > 0 ? box.max.z : box.min.z;
    if (plane.x * x + plane.y * y + plane.z * z + plane.w < -slack) return false;
  }
  return true;
}

core::Bounds bounds_of(const TerrainDraw& draw) {
  const float side = draw.side_m > 0 ? draw.side_m : kLargestGrid * draw.cell_m;
  const float bottom = draw.origin.y + draw.height_min_m;
  return {{draw.origin.x, bottom - draw.skirt_m, draw.origin.z},
          {draw.origin.x + side, bottom + draw.height_range_m, draw.origin.z + side}};
}

core::Bounds bounds_of(const MeshDraw& draw) {
  return core::Bounds::around(draw.origin + draw.box_centre, draw.box_half_extent + kSwayM);
}

// The box around the turned box: each of its half extents is the sum of the projections of the
// turned axes.
core::Bounds bounds_of(const ObjectDraw& draw) {
  const glm::mat3 axes = object_axes(draw);
  const glm::vec3 extent = glm::abs(axes[0]) * draw.box_half_extent.x +
                           glm::abs(axes[1]) * draw.box_half_extent.y +
                           glm::abs(axes[2]) * draw.box_half_extent.z;
  return core::Bounds::around(draw.origin + axes * draw.box_centre, extent + kSwayM);
}

bool any_reaches(std::span<const PointLight> lights, const core::Bounds& box) {
  return std::ranges::any_of(lights, [&](const PointLight& light) {
    const glm::vec3 away = light.position - glm::clamp(light.position, box.min, box.max);
    return glm::dot(away, away) < light.range_m * light.range_m;
  });
}

glm::mat3 object_axes(const ObjectDraw& draw) {
  const auto [x, y, z, w] = draw.rotation;
  return {
      glm::vec3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)) * draw.scale.x,
      glm::vec3(2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)) * draw.scale.y,
      glm::vec3(2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)) * draw.scale.z};
}

}  // namespace psygen::render
