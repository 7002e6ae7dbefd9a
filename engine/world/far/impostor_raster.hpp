// Bakes the impostor of a model (core/vertex_layout.hpp): rasterises its triangles from several
// directions, lit through its own crown, and makes the smaller levels, which keep the opaque area.
// Pure, any thread, the same bits on every machine; linear in the triangles.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/world/far/outline.hpp"

namespace psygen::world {

// The area that every view of an impostor shows: `half_width_m` to both sides of the axis through
// the base point, from `bottom_m` to `top_m`. And the ambient visibility of its quad.
struct ImpostorFrame {
  float half_width_m = 0, bottom_m = 0, top_m = 0;
  float ambient = 1;
};

// The impostor of triangles over `corners`, in metres from the base point. Only the first `views`
// differ; they repeat. The projection is from the side, without perspective.
core::ImpostorTexture bake_impostor(std::span<const Corner> corners,
                                    std::span<const std::uint16_t> indices,
                                    const ImpostorFrame& frame, std::uint32_t views);

}  // namespace psygen::world
