#include "engine/scene/meshes/mesh_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

namespace psygen::scene {
namespace {

// The number of triangles up to the last one with three different corners.
std::size_t used_triangles(std::span<const std::uint16_t> indices) {
  std::size_t count = indices.size() / 3;
  const auto empty = [&](std::size_t t) {
    const std::uint16_t a = indices[3 * t], b = indices[3 * t + 1], c = indices[3 * t + 2];
    return a == b || b == c || c == a;
  };
  while (count > 0 && empty(count - 1))
    --count;
  return count;
}

core::Bounds box_of(std::span<const core::ModelVertex> vertices,
                    std::span<const std::uint16_t> indices, const core::Bounds& box) {
  glm::ivec3 low(INT16_MAX), high(INT16_MIN);
  float reach_m = 0;
  for (const std::uint16_t index : indices) {
    const core::ModelVertex& v = vertices[index];
    const glm::ivec3 place(v.position[0], v.position[1], v.position[2]);
    low = glm::min(low, place);
    high = glm::max(high, place);
    reach_m = std::max(reach_m, core::billboard_reach_m(v));
  }
  const glm::vec3 scale = box.half_extent() / 32767.0F;
  const glm::vec3 around(reach_m, 0, reach_m);
  return {box.centre() + glm::vec3(low) * scale - around,
          box.centre() + glm::vec3(high) * scale + around};
}

}  // namespace

MeshParts mesh_parts(std::span<const core::ModelVertex> vertices,
                     std::span<const std::uint16_t> indices, const core::Bounds& box) {
  MeshParts parts;
  const std::size_t triangles = used_triangles(indices);
  parts.index_count = static_cast<std::uint32_t>(3 * triangles);
  const std::size_t each =
      std::max<std::size_t>((triangles + MeshParts::kMax - 1) / MeshParts::kMax, 1);
  parts.indices_each = static_cast<std::uint32_t>(3 * each);
  for (std::size_t first = 0; first < triangles; first += each) {
    const std::size_t count = std::min(each, triangles - first);
    parts.boxes[parts.count++] = box_of(vertices, indices.subspan(3 * first, 3 * count), box);
  }
  return parts;
}

}  // namespace psygen::scene
