// A mesh in the vertex format that is drawn (core::ObjectVertex), kept by the host and copied again
// after an eviction. Pure; any thread.
#pragma once

#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/mesh_data.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::scene {

struct PackedMesh {
  std::vector<core::ObjectVertex> vertices;
  std::vector<std::uint16_t> indices;
  core::Bounds box;  // of the snorm16 positions
};

// Packs a mesh. Fails as core::check(), and with kOverBudget beyond core::kMaxMeshVertices
// (core::split). Missing normals are the means of the adjacent triangles' normals, weighted by
// area. O(n).
core::Result<PackedMesh> pack(const core::MeshData& mesh);

}  // namespace psygen::scene
