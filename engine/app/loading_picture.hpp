// Image of a window while its world loads: hills in the evening, the name of the world, a bar and
// the current task. A pure function of its arguments; the name determines the hills. Any thread.
#pragma once

#include <string_view>

#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"

namespace psygen::app {

// `fraction` in [0, 1]. Sizes scale with the image's height.
render::HudDrawing loading_picture(std::string_view world, std::string_view label, double fraction,
                                   core::Extent picture);

}  // namespace psygen::app
