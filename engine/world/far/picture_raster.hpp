// Bakes the picture of a model (core/model_picture.hpp): rasterises its triangles seen from around,
// with the light that a tree's own crown leaves them, and makes the smaller levels, which keep the
// area that is opaque. Pure, any thread, the same bits on every machine; linear in the triangles.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/model_picture.hpp"
#include "engine/world/far/outline.hpp"

namespace psygen::world {

// What every view of a picture shows: so far to both sides of the foot's axis, from `bottom_m` to
// `top_m`; and the ambient visibility of the quad that it is shown on.
struct PictureFrame {
  float half_width_m = 0, bottom_m = 0, top_m = 0;
  float ambient = 1;
};

// The picture of triangles over `corners`, in metres from the foot. Only the first `views` differ;
// they repeat. Positions are as seen from the side, without perspective.
core::ModelPicture bake_picture(std::span<const Corner> corners,
                                std::span<const std::uint16_t> indices, const PictureFrame& frame,
                                std::uint32_t views);

}  // namespace psygen::world
