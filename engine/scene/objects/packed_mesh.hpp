// A mesh in the bytes that are drawn (core::ObjectVertex), kept by the host: what is evicted from
// the geometry memory is copied there again. Pure; any thread.
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

// Fails like core::check(), and with kOverBudget beyond core::kMaxMeshVertices (core::split).
// Missing normals are the means of those of the triangles around a vertex, by area. O(n).
core::Result<PackedMesh> pack(const core::MeshData& mesh);

}  // namespace psygen::scene
