// report.html: one self-contained page about a run, for people. Headline figures, facts, and plots
// of frame time, systems, missing geometry, cache bytes and synthesis over the flight. Without
// external resources; follows the reader's light or dark theme; readable without scripts, which
// only show values under the pointer. Not for programs: summary.json is. Pure, apart from writing.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/error.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// The page. Its size does not grow with the number of frames: plots have at most 900 columns.
std::string report_html(const FrameLog& log, const Summary& summary);

// Writes the page to a file. Fails with kIo and the path.
core::Result<void> write_report_html(const std::filesystem::path& path, const FrameLog& log,
                                     const Summary& summary);

}  // namespace psygen::telemetry
