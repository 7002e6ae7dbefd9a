// The parts of report.html, and how figures appear in it. Each part is a piece of HTML with its
// text escaped. Private to engine/telemetry. Pure.
#pragma once

#include <fmt/format.h>

#include <string>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/report_plot.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/units.hpp"

namespace psygen::telemetry {

// The escaped text of a figure; for a missing one a dash with the reason as its tooltip.
template <class T, class Text>
std::string shown(const Measured<T>& measured, const Text& text) {
  if (measured.has_value()) return escaped(text(static_cast<double>(*measured)));
  return fmt::format("<span class=\"none\" title=\"{}\">–</span>", escaped(measured.reason));
}

// The headline figures, each in a box, and whether the picture is as requested.
std::string report_cards(const Summary& summary);
// All plots over the flight's time.
std::string report_plots(const FrameLog& log, const Summary& summary);
// Tables of all other figures.
std::string report_facts(const Summary& summary);

}  // namespace psygen::telemetry
