#include "engine/scene/objects/packed_mesh.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/models/kit/packing.hpp"

namespace psygen::scene {
namespace {

core::Bounds box_of(const std::vector<glm::vec3>& positions) {
  core::Bounds box{positions.front(), positions.front()};
  for (const glm::vec3& p : positions)
    box = {glm::min(box.min, p), glm::max(box.max, p)};
  return box;
}

std::vector<glm::vec3> normals_of(const core::MeshData& mesh) {
  if (!mesh.normals.empty()) return mesh.normals;
  std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* corner = &mesh.indices[i];
    const glm::vec3 a = mesh.positions[corner[0]];
    const glm::vec3 across =
        glm::cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a);
    for (int k = 0; k < 3; ++k)
      normals[corner[k]] += across;
  }
  return normals;
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
  const std::vector<glm::vec3> normals = normals_of(mesh);
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

}  // namespace psygen::scene
