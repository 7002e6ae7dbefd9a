// Water at a place, in words. Main thread.
#pragma once

#include <QString>

#include "editor/view/water_probe.hpp"

namespace psygen::editor {

// Body, surface and depth in metres; of a river also speed and discharge.
QString water_text(const WaterFacts& water);

}  // namespace psygen::editor
