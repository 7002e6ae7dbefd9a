#include "engine/core/mesh_shapes.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace psygen::core {
namespace {

constexpr std::uint32_t kAround = 8, kUp = 5;
static_assert(2 * kAround * kUp == kEllipsoidTriangles);
constexpr float kUnderside = -0.2F;  // of the upward component of the direction from the centre

}  // namespace

void add_ellipsoid(MeshData& mesh, const glm::vec3& middle, const glm::vec3& half,
                   const glm::vec3& above, const glm::vec3& below) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t up = 0; up <= kUp; ++up) {
    const float v = std::numbers::pi_v<float> * (static_cast<float>(up) / kUp - 0.5F);
    for (std::uint32_t side = 0; side < kAround; ++side) {
      const float u = 2 * std::numbers::pi_v<float> * static_cast<float>(side) / kAround;
      const glm::vec3 way(std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u));
      mesh.positions.push_back(middle + half * way);
      mesh.normals.push_back(way / half);
      mesh.colours.push_back(way.y < kUnderside ? below : above);
    }
  }
  for (std::uint32_t up = 0; up < kUp; ++up) {
    for (std::uint32_t side = 0; side < kAround; ++side) {
      const std::uint32_t next = (side + 1) % kAround, low = first + up * kAround,
                          high = low + kAround;
      for (const std::uint32_t i :
           {low + side, high + side, high + next, low + side, high + next, low + next})
        mesh.indices.push_back(i);
    }
  }
}

void add_triangle(MeshData& mesh, const std::array<glm::vec3, 3>& corners,
                  const glm::vec3& colour) {
  const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  for (const glm::vec3& corner : corners) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal.y < 0 ? -normal : normal);
    mesh.colours.push_back(colour);
  }
}

}  // namespace psygen::core
