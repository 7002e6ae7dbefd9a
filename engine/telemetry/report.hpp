// report.html: one self-contained page about a run, for people. Headline figures, facts, and plots
// of frame time, the picture's error, systems, missing geometry, cache and modelers over the
// flight, with zoom, values, and each frame whole. Without external resources but the run's
// pictures beside it; follows the reader's light or dark theme; without scripts the figures can be
// read, not the plots. Not for programs: summary.json is. Pure, apart from writing.
#pragma once

#include <filesystem>
#include <string>

#include "engine/core/error.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// The page. At most 20,000 frames are in it: of longer flights every nth, the slowest of so many.
std::string report_html(const FrameLog& log, const Summary& summary);

// Writes the page to a file. Fails with kIo and the path.
core::Result<void> write_report_html(const std::filesystem::path& path, const FrameLog& log,
                                     const Summary& summary);

}  // namespace psygen::telemetry
