#include "engine/scene/objects/packed_mesh.hpp"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "engine/models/kit/packing.hpp"

namespace psygen::scene {
namespace {

core::Bounds box_of(const std::vector<glm::vec3>& positions) {
  core::Bounds box{positions.front(), positions.front()};
  for (const glm::vec3& p : positions)
    box = {glm::min(box.min, p), glm::max(box.max, p)};
  return box;
}

core::ModelVertex pack_vertex(const models::BoxPacker& packer, const glm::vec3& position,
                              const glm::vec3& normal, const glm::vec3& colour) {
  core::ModelVertex vertex{};
  packer.pack(position, vertex.position);
  const float length = glm::length(normal);
  const glm::vec3 unit = length > 1e-12F ? normal / length : glm::vec3(0, 1, 0);
  const glm::vec2 e = models::encode_octahedral(unit);
  vertex.normal[0] = models::pack_snorm16(e.x);
  vertex.normal[1] = models::pack_snorm16(e.y);
  vertex.ambient = 255;
  for (int i = 0; i < 3; ++i)
    vertex.colour[i] = models::pack_albedo(colour[i]);
  return vertex;
}

constexpr std::size_t kFewestIndices = 3 * 48;  // minimum for a mesh with a coarser level
constexpr std::size_t kMinIndices = 3 * 8;      // of any level
constexpr double kMinArea = 0.5;  // of any level, as a fraction of the finest level's surface

// Simplification takes time with the square of the triangles of a vertex.
constexpr std::uint64_t kMaxSquares = 50'000'000;  // usual meshes: 36 for each vertex

bool is_tangled(const std::vector<std::uint16_t>& indices, std::size_t vertices) {
  std::vector<std::uint64_t> triangles(vertices, 0);
  for (const std::uint16_t index : indices)
    ++triangles[index];
  std::uint64_t squares = 0;
  for (const std::uint64_t count : triangles)
    squares += count * count;
  return squares > kMaxSquares;
}

// Of the surface of all triangles. Simplifying loose triangles removes them one by one instead of
// making a surface coarser, so the total shrinks.
double area_m2(const std::vector<glm::vec3>& places, const std::vector<std::uint16_t>& indices) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::vec3& a = places[indices[i]];
    area += 0.5 * static_cast<double>(glm::length(
                      glm::cross(places[indices[i + 1]] - a, places[indices[i + 2]] - a)));
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
  mesh.vertices.shrink_to_fit();
  mesh.indices.shrink_to_fit();
  return mesh;
}

}  // namespace

core::Result<PackedMesh> pack(const core::MeshData& mesh) {
  if (auto ok = core::check(mesh); !ok) return tl::unexpected(ok.error());
  if (mesh.positions.size() > core::kMaxMeshVertices) {
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("a mesh has {} vertices; at most {} can be drawn as one",
                                  mesh.positions.size(), core::kMaxMeshVertices));
  }
  PackedMesh packed;
  packed.box = box_of(mesh.positions);
  const models::BoxPacker packer(packed.box);
  const std::vector<glm::vec3> normals =
      mesh.normals.empty() ? core::normal_sums(mesh) : mesh.normals;
  packed.vertices.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 colour = mesh.colours.empty() ? glm::vec3(1.0F) : mesh.colours[i];
    const glm::vec2 uv = mesh.uvs.empty() ? glm::vec2(0.0F) : mesh.uvs[i];
    packed.vertices.push_back(
        {pack_vertex(packer, mesh.positions[i], normals[i], colour), {uv.x, uv.y}});
  }
  packed.indices.reserve(mesh.indices.size());
  for (const std::uint32_t index : mesh.indices)
    packed.indices.push_back(static_cast<std::uint16_t>(index));
  return packed;
}

std::vector<ObjectLevel> object_levels(PackedMesh finest, std::size_t most) {
  std::vector<ObjectLevel> levels;
  levels.reserve(most);  // `all` stays where it is
  levels.push_back({std::move(finest), 0});
  const PackedMesh& all = levels[0].mesh;
  const std::size_t count = all.vertices.size(), stride = sizeof(glm::vec3);
  if (is_tangled(all.indices, count)) return levels;
  // The places as they are drawn. At a seam, code often computes two that are almost equal; packed
  // they are equal, and the simplifier sees one surface.
  std::vector<glm::vec3> places;
  places.reserve(count);
  for (const core::ObjectVertex& vertex : all.vertices)
    places.push_back(models::unpack_position(vertex.model, all.box));
  const float* const first = &places.front().x;
  const auto scale = static_cast<double>(meshopt_simplifyScale(first, count, stride));
  const double min_area = kMinArea * area_m2(places, all.indices);
  // Each level comes from the one before: all together cost little more than the first.
  std::vector<std::uint16_t> last = all.indices;
  while (levels.size() < most && last.size() >= kFewestIndices) {
    const std::size_t before = last.size();
    std::vector<std::uint16_t> indices(before);
    float error = 0;
    indices.resize(meshopt_simplify(indices.data(), last.data(), before, first, count, stride,
                                    before / 12 * 3, std::numeric_limits<float>::max(), 0, &error));
    if (indices.size() < kMinIndices || 2 * indices.size() > before ||
        area_m2(places, indices) < min_area)
      break;
    const double error_m = levels.back().error_m + error * scale;
    levels.push_back({with_indices(levels[0].mesh, indices), error_m});
    last = std::move(indices);
  }
  return levels;
}

}  // namespace psygen::scene
