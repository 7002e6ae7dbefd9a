// The parts of report.html, and how figures appear in it. Each part is a piece of HTML with its
// text escaped. Private to engine/telemetry. Pure.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/page_rows.hpp"
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
// The frames that the rows of the plots stand for. Where there are too many, each is the slowest of
// `every`.
struct ShownFrames {
  std::size_t every = 1;
  std::vector<std::size_t> frames;  // by their place in the log, ascending
};
ShownFrames shown_frames(const FrameLog& log);
// Takes a plot's values of all frames to those of the rows: of peaks the largest of each row's.
void thin(Plot& plot, const ShownFrames& shown);
// What is known of the rows beside the plots.
PageRows page_rows(const FrameLog& log, const Summary& summary, const ShownFrames& shown);
// All plots over the flight's time.
std::string report_plots(const FrameLog& log, const Summary& summary);
// Tables of all other figures.
std::string report_facts(const Summary& summary);

}  // namespace psygen::telemetry
