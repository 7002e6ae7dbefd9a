// From a frame's camera, light and palette to what the shaders read. Pure function. Private to
// engine/render.
#pragma once

#include "engine/core/surface_provider.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// `size` in pixels, both > 0.
shaders::FrameData frame_data(const FrameInput& input, core::Extent size,
                              const PresetTraits& traits = {});

}  // namespace psygen::render
