#include "engine/scene/draws/mesh_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "engine/scene/draws/parts.hpp"
#include "engine/scene/draws/seen.hpp"

namespace psygen::scene {
namespace {

// Triangles up to the last that has three corners.
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

glm::vec2 flat(glm::vec3 v) {
  return {v.x, v.z};
}

// Steps so large that neighbours can often be one draw.
float in_steps(float share) {
  constexpr float kSteps = 6;
  return std::round(share * kSteps) / kSteps;
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

bool add_parts(const MeshParts& parts, const View* view, const GroundSun& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws) {
  bool any = false;
  DrawParts run(draw, draws);
  for (std::uint32_t i = 0; i < parts.count; ++i) {
    if (view != nullptr && !mesh_can_be_seen(parts.boxes[i], draw.origin, *view)) continue;
    run.set_sun(in_steps(
        sun_over(sun, flat(parts.boxes[i].min) / side_m, flat(parts.boxes[i].max) / side_m)));
    const std::uint32_t first = i * parts.indices_each;
    run.add({first, std::min(parts.indices_each, parts.index_count - first)});
    any = true;
  }
  return any;
}

}  // namespace psygen::scene
