// A mesh in the vertex format that is drawn (core::ObjectVertex), kept by the host and copied again
// after an eviction, and its LODs. Pure; any thread.
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

// One LOD of an object's mesh.
struct ObjectLevel {
  PackedMesh mesh;
  double error_m = 0;  // accumulated error of the simplifier; 0 at level 0, and grows
};

// Makes one to `most` levels (>= 1), simplified by meshoptimizer: fewer triangles between some of
// the same vertices. Deterministic for one version of meshoptimizer. Each has at most half the
// triangles of the one before, about a quarter if the shape allows it, and at least half its
// surface. The first is `finest`. Small meshes have one level, and so do those with thousands of
// triangles at one vertex, which take too long. O(n log n) for n triangles.
std::vector<ObjectLevel> object_levels(PackedMesh finest, std::size_t most);

}  // namespace psygen::scene
