#include "engine/render/meshes/view_volume.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace psygen::render {

namespace {

constexpr float kSlackShare = 1e-6F;  // slack for rounding, relative to a box's coordinates

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

bool any_reaches(std::span<const PointLight> lights, const core::Bounds& box) {
  return std::ranges::any_of(lights, [&](const PointLight& light) {
    const glm::vec3 away = light.position - glm::clamp(light.position, box.min, box.max);
    return glm::dot(away, away) < light.range_m * light.range_m;
  });
}

}  // namespace psygen::render
