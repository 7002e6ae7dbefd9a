// Bounds of the parts of a merged mesh, which is so large that many of its triangles may be out of
// view. Its triangles come block by block in Morton order (world/far/merged_models.hpp), so that
// neighbours in the list are neighbours in space. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/scene/components.hpp"

namespace psygen::scene {

// The parts of a mesh whose positions span `box`. Reads each index once, 4 to 6 µs for a node
// (psygen_bench_landing), on its modeler (mesh_annotations.hpp). Leaves out triangles at the end
// that name a vertex twice.
MeshParts mesh_parts(std::span<const core::ModelVertex> vertices,
                     std::span<const std::uint16_t> indices, const core::Bounds& box);

}  // namespace psygen::scene
