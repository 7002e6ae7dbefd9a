#include "engine/core/mesh_data.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string_view>
#include <unordered_map>

namespace psygen::core {
namespace {

// Checks the length of a list, and that the absolute value of every number is at most `most`.
template <class Vector>
Result<void> check_list(std::string_view name, const std::vector<Vector>& list, std::size_t count,
                        float most) {
  if (!list.empty() && list.size() != count)
    return invalid_argument(
        fmt::format("a mesh has {} positions but {} {}", count, list.size(), name));
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (glm::length_t axis = 0; axis < list[i].length(); ++axis) {
      if (std::abs(list[i][axis]) <= most) continue;
      return invalid_argument(fmt::format("{}[{}] of a mesh is {}; at most {} is allowed", name, i,
                                          list[i][axis], most));
    }
  }
  return {};
}

constexpr std::uint32_t kAround = 8, kUp = 5;
static_assert(2 * kAround * kUp == kEllipsoidTriangles);
constexpr float kUnderside = -0.2F;  // of the upward component of the direction from the centre

}  // namespace

Result<void> check(const MeshData& mesh) {
  const std::size_t count = mesh.positions.size();
  if (count == 0 || mesh.indices.empty()) return invalid_argument("a mesh has no triangles");
  if (mesh.indices.size() % 3 != 0) {
    return invalid_argument(
        fmt::format("a mesh has {} indices; three make a triangle", mesh.indices.size()));
  }
  if (count > UINT32_MAX || mesh.indices.size() > UINT32_MAX)
    return invalid_argument("a mesh has more than 2^32 vertices or indices");
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (mesh.indices[i] >= count) {
      return invalid_argument(fmt::format("indices[{}] of a mesh is {}, but it has {} vertices", i,
                                          mesh.indices[i], count));
    }
  }
  constexpr float kMaxUv = 1e6F;
  return check_list("positions", mesh.positions, count, kMaxMeshReachM)
      .and_then([&] { return check_list("normals", mesh.normals, count, 1e6F); })
      .and_then([&] { return check_list("uvs", mesh.uvs, count, kMaxUv); })
      .and_then([&] { return check_list("colours", mesh.colours, count, 1e6F); });
}

std::vector<MeshData> split(const MeshData& mesh, std::uint32_t max_vertices) {
  std::vector<MeshData> parts;
  if (mesh.positions.size() <= max_vertices) {
    parts.push_back(mesh);
    return parts;
  }
  std::unordered_map<std::uint32_t, std::uint32_t> placed;  // vertex → its index in the part
  const auto place = [&](std::uint32_t vertex) {
    MeshData& part = parts.back();
    const auto [at, is_new] =
        placed.try_emplace(vertex, static_cast<std::uint32_t>(part.positions.size()));
    if (is_new) {
      part.positions.push_back(mesh.positions[vertex]);
      if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[vertex]);
      if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[vertex]);
      if (!mesh.colours.empty()) part.colours.push_back(mesh.colours[vertex]);
    }
    part.indices.push_back(at->second);
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    if (parts.empty() || parts.back().positions.size() + 3 > max_vertices) {
      parts.emplace_back();
      placed.clear();
    }
    for (std::size_t corner = 0; corner < 3; ++corner)
      place(mesh.indices[i + corner]);
  }
  return parts;
}

std::vector<glm::vec3> normal_sums(const MeshData& mesh) {
  std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0.0F));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* corner = &mesh.indices[i];
    const glm::vec3 a = mesh.positions[corner[0]];
    const glm::vec3 across =
        glm::cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a);
    for (int k = 0; k < 3; ++k)
      sums[corner[k]] += across;
  }
  return sums;
}

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
