#include "engine/scene/objects/object_levels.hpp"

#include <meshoptimizer.h>

#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace psygen::scene {
namespace {

constexpr std::size_t kFewestIndices = 3 * 48;  // minimum for a mesh with a coarser level
constexpr std::size_t kMinIndices = 3 * 8;      // of any level
constexpr double kMinArea = 0.5;  // of any level, as a fraction of the finest level's surface

// Of the surface of all triangles. Simplifying loose triangles removes them one by one instead of
// making a surface coarser, so the total shrinks.
double area_m2(const core::MeshData& mesh, const std::vector<std::uint16_t>& indices) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::vec3& a = mesh.positions[indices[i]];
    area += 0.5 * static_cast<double>(glm::length(glm::cross(mesh.positions[indices[i + 1]] - a,
                                                             mesh.positions[indices[i + 2]] - a)));
  }
  return area;
}

// The vertices that the indices use, in the order of use.
PackedMesh with_indices(const PackedMesh& finest, std::vector<std::uint16_t> indices) {
  PackedMesh mesh;
  mesh.box = finest.box;
  mesh.indices = std::move(indices);
  meshopt_optimizeVertexCache(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                              finest.vertices.size());
  mesh.vertices.resize(finest.vertices.size());
  mesh.vertices.resize(meshopt_optimizeVertexFetch(
      mesh.vertices.data(), mesh.indices.data(), mesh.indices.size(), finest.vertices.data(),
      finest.vertices.size(), sizeof(core::ObjectVertex)));
  return mesh;
}

}  // namespace

std::vector<ObjectLevel> object_levels(const core::MeshData& mesh, PackedMesh finest,
                                       std::size_t most) {
  std::vector<ObjectLevel> levels;
  levels.push_back({std::move(finest), 0});
  const float* const places = &mesh.positions.front().x;
  const std::size_t count = mesh.positions.size(), stride = sizeof(glm::vec3);
  const auto scale = static_cast<double>(meshopt_simplifyScale(places, count, stride));
  const double min_area = kMinArea * area_m2(mesh, levels[0].mesh.indices);
  // Each level comes from the one before: all together cost little more than the first.
  std::vector<std::uint16_t> last = levels[0].mesh.indices;
  while (levels.size() < most && last.size() >= kFewestIndices) {
    const std::size_t before = last.size();
    std::vector<std::uint16_t> indices(before);
    float error = 0;
    indices.resize(meshopt_simplify(indices.data(), last.data(), before, places, count, stride,
                                    before / 12 * 3, std::numeric_limits<float>::max(), 0, &error));
    if (indices.size() < kMinIndices || 2 * indices.size() > before ||
        area_m2(mesh, indices) < min_area)
      break;
    const double error_m = levels.back().error_m + error * scale;
    levels.push_back({with_indices(levels[0].mesh, indices), error_m});
    last = std::move(indices);
  }
  return levels;
}

}  // namespace psygen::scene
