// Cuts out of triangles what their texture leaves out: cards of leaves get the outline of the
// leaves. So they are right wherever only triangles and colours of vertices are known: at all
// levels, in shadows, in pictures for afar and in exports. Pure; any thread.
#pragma once

#include <cstddef>

#include "engine/core/mesh_data.hpp"
#include "engine/gltf/model.hpp"

namespace psygen::handmade {

// How often sides are halved where the border of what is drawn runs.
inline constexpr int kMaxCutDepth = 3;
// Less than that where a model has so many triangles of such materials that it would get too large.
int cut_depth(std::size_t triangles);

// The parts of a mesh with uvs that are drawn: where the texture times `opacity` has at least
// `min_opacity`. Their area is that of the pixels that are drawn, also where these are finer than
// what is cut. Linear in the triangles and in 4^depth.
core::MeshData cut_out(const core::MeshData& mesh, const image::Image& image, float opacity,
                       float min_opacity, int depth);

}  // namespace psygen::handmade
