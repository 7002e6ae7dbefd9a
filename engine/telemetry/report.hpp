// report.html: one self-contained page about a run, for people. Headline figures, facts, and plots
// of frame time, systems, missing geometry, cache bytes and synthesis over the flight. No external
// resources; follows the reader's light or dark theme; readable without scripts, values under the
// pointer with them.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/error.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// The page. Its size does not grow with the number of frames: plots have at most 900 columns.
std::string report_html(const FrameLog& log, const Summary& summary);

// The page in a file. Fails with kIo and the path.
core::Result<void> write_report_html(const std::filesystem::path& path, const FrameLog& log,
                                     const Summary& summary);

}  // namespace psygen::telemetry
