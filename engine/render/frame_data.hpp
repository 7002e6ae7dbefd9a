// Converts a frame's camera, light and palette to the data that the shaders read. Pure function,
// any thread. It writes no buffers (frame_slot.hpp). Private to engine/render.
#pragma once

#include "engine/core/surface_provider.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/types.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The data of a frame. `size` is that of the picture in pixels, both > 0. `traits` has the
// cascades.
shaders::FrameData frame_data(const FrameInput& input, core::Extent size,
                              const PresetTraits& traits = {});

}  // namespace psygen::render
