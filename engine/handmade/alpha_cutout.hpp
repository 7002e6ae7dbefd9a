// Cuts triangles along the transparent parts of their texture, so that cards of leaves get the
// outline of the leaves. They then look right everywhere that knows only triangles and vertex
// colours: at all levels, in shadows, in impostors and in exports. Pure; any thread.
#pragma once

#include <cstddef>

#include "engine/core/mesh_data.hpp"
#include "engine/gltf/model.hpp"

namespace psygen::handmade {

// Maximum number of times that sides are halved along the border.
inline constexpr int kMaxCutDepth = 3;
// The depth for a model with so many triangles of such materials; large models get less.
int cut_depth(std::size_t triangles);

// The drawn parts of a mesh with uvs: where the texture times `opacity` is at least
// `min_opacity`. Their area equals the area of the drawn pixels, even if these are finer than the
// cuts. Linear in the triangles and in 4^depth.
core::MeshData alpha_cutout(const core::MeshData& mesh, const image::Image& image, float opacity,
                            float min_opacity, int depth);

}  // namespace psygen::handmade
