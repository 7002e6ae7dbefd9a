// Parts of report.html, and formatting of its numbers. Each part is a piece of HTML with escaped
// text. Private to engine/telemetry. Pure.
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

// Escaped text of a number; for a missing one, a dash with the reason as its tooltip.
template <class T, class Text>
std::string shown(const Measured<T>& measured, const Text& text) {
  if (measured.has_value()) return escaped(text(static_cast<double>(*measured)));
  return fmt::format("<span class=\"none\" title=\"{}\">–</span>", escaped(measured.reason));
}

// Headline numbers, each in a box, and the verdict on the image.
std::string report_cards(const Summary& summary);
// Frames that the rows of the plots represent. If there are too many, each is the slowest of
// `every`.
struct ShownFrames {
  std::size_t every = 1;
  std::vector<std::size_t> frames;  // positions in the log, ascending
};
ShownFrames shown_frames(const FrameLog& log);
// Reduces a plot's values of all frames to those of the rows; a row of peaks has the largest value.
void thin(Plot& plot, const ShownFrames& shown);
// Data of the rows besides the plots.
PageRows page_rows(const FrameLog& log, const Summary& summary, const ShownFrames& shown);
// All plots over the flight's time.
std::string report_plots(const FrameLog& log, const Summary& summary);
// Tables of all other numbers.
std::string report_facts(const Summary& summary);

}  // namespace psygen::telemetry
