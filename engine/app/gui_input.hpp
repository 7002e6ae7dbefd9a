// Passes the user's input to Dear ImGui. Main thread only.
#pragma once

#include "engine/platform/input.hpp"

struct ImGuiIO;

namespace psygen::app {

// Call once for a context, before its first frame.
void prepare_input(ImGuiIO& io);

// Call before each frame. A key or button that was pressed and released since the last frame counts
// as held in this one. Positions that are not finite count as outside of the image.
void feed_input(const platform::InputState& input, ImGuiIO& io);

}  // namespace psygen::app
