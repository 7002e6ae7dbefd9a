// Water at a place, in words. Main thread.
#pragma once

#include <QString>

#include "engine/world/water.hpp"

namespace psygen::editor {

// Body, surface and depth in metres; of a river also speed and discharge. Empty: dry.
QString water_text(const world::WaterPoint& water);

}  // namespace psygen::editor
