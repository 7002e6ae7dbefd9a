// report.html: a self-contained page about a run, for people. Shows headline numbers, facts, and
// plots of frame time, screen-space error, systems, missing geometry, cache and modelers over the
// flight, with zoom, values, and details of each frame. Needs no external resources except the
// run's images next to it; follows the reader's light or dark theme. Without scripts the numbers
// are readable, but not the plots. Programs read summary.json. Pure, apart from writing.
#pragma once

#include <string>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// The page. It contains at most 20,000 frames: of longer flights, the slowest of every n frames.
std::string report_html(const FrameLog& log, const Summary& summary);

}  // namespace psygen::telemetry
