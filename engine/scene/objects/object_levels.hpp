// The levels of detail of an object's mesh, simplified by meshoptimizer: fewer triangles between
// some of the same vertices. Pure; any thread. The same mesh gives the same levels with the same
// version of meshoptimizer.
#pragma once

#include <vector>

#include "engine/scene/objects/packed_mesh.hpp"

namespace psygen::scene {

struct ObjectLevel {
  PackedMesh mesh;
  double error_m = 0;  // as the simplifier measures it, in all; 0 at level 0, and grows
};

// One to `most` levels (>= 1), each with at most half the triangles of the one before, and about a
// quarter where the shape allows it, and at least half its surface. The first is `finest`, which is
// packed from `mesh`. Small meshes have one. O(n log n) for n triangles.
std::vector<ObjectLevel> object_levels(const core::MeshData& mesh, PackedMesh finest,
                                       std::size_t most);

}  // namespace psygen::scene
