// The parts of report.html, and how a figure is shown in it. Private to engine/telemetry. Pure.
#pragma once

#include <fmt/format.h>

#include <string>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/report_plot.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/units.hpp"

namespace psygen::telemetry {

// Escaped text of a figure; a dash that tells the reason where it is missing.
template <class T, class Text>
std::string shown(const Measured<T>& measured, const Text& text) {
  if (measured.has_value()) return escaped(text(static_cast<double>(*measured)));
  return fmt::format("<span class=\"none\" title=\"{}\">–</span>", escaped(measured.reason));
}

// The figures that one looks at first, each in a box; whether the picture is what was asked for.
std::string report_cards(const Summary& summary);
// All plots over the flight's time.
std::string report_plots(const FrameLog& log, const Summary& summary);
// Tables of everything else.
std::string report_facts(const Summary& summary);

}  // namespace psygen::telemetry
