// A mesh that reaches so far that much of it may be out of view: the one for everything that stands
// on a node. Its triangles come block by block in Morton order (world/far/merged_models.hpp), so
// that those that follow each other lie near each other. Values; nothing of what is in the cache.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/state.hpp"

namespace psygen::scene {

// From the vertices and triangles of a mesh whose positions span this box: looks at each index
// once, 4 to 6 µs for a node (psygen_bench_landing), which its modeler spends (mesh_notes.hpp).
// Triangles at the end that name a vertex twice are left out.
MeshParts mesh_parts(std::span<const core::ModelVertex> vertices,
                     std::span<const std::uint16_t> indices, const core::Bounds& box);

// Adds draws for the parts that can be seen, or without a view for all, in the light that the
// ground of their node, of this size, lets through; `draw` is that of the whole mesh. Returns
// whether there are any.
bool add_parts(const MeshParts& parts, const View* view, const GroundSun& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws);

}  // namespace psygen::scene
