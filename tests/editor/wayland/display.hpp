// The Wayland display of the tests in this folder.
#pragma once

#include "tests/engine/platform/wayland_display.hpp"

namespace psygen::editor {

// Exists while tests run.
platform::WaylandDisplay& display();

}  // namespace psygen::editor
