// LODs of an object's mesh, simplified by meshoptimizer: fewer triangles between some of the same
// vertices. Pure; any thread. Deterministic for one version of meshoptimizer.
#pragma once

#include <vector>

#include "engine/scene/objects/packed_mesh.hpp"

namespace psygen::scene {

struct ObjectLevel {
  PackedMesh mesh;
  double error_m = 0;  // accumulated error of the simplifier; 0 at level 0, and grows
};

// Makes one to `most` levels (>= 1). Each has at most half the triangles of the one before, about a
// quarter if the shape allows it, and at least half its surface. The first is `finest`, packed from
// `mesh`. Small meshes have one level. O(n log n) for n triangles.
std::vector<ObjectLevel> object_levels(const core::MeshData& mesh, PackedMesh finest,
                                       std::size_t most);

}  // namespace psygen::scene
