// The picture of a window while its world is made: hills in the evening, the name of the world, a
// bar and what goes on. A pure function of its arguments; the hills follow from the name. Any
// thread.
#pragma once

#include <string_view>

#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"

namespace psygen::app {

// `fraction` in [0, 1]. Sizes follow the picture's height.
render::HudDrawing loading_picture(std::string_view world, std::string_view label, double fraction,
                                   core::Extent picture);

}  // namespace psygen::app
