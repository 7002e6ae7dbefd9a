// The plots of report.html over the flight's time, and the details of each frame. Pure.
#pragma once

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/page.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// A piece of HTML with escaped text.
std::string report_plots(const FrameLog& log, const Summary& summary);

}  // namespace psygen::telemetry
