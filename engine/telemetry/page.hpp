// Pages with plots: style and script as texts to embed, and the data of the rows behind the plots,
// which are frames of a flight or of a comparison. The script zooms over the rows, shows their
// values, and one row in detail. Pure; linear in rows.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/telemetry/report_plot.hpp"

namespace psygen::telemetry {

// page_style.css: a palette of eight colours and two greys (fill0 … fill9, stroke0 …, swatch0 …),
// for light and dark themes.
std::string_view page_style();

// page_script.js, for pages with plots over time; put it at the end of the page. Draws the figures
// of report_plot.hpp over the rows of PageRows, all with one zoom. Shows the values under the
// pointer, the distribution of the visible frames, and one frame in detail. Plain JavaScript and
// SVG without external resources.
std::string_view page_script();

// A value of every row that no plot shows.
struct RowFigure {
  std::string name, unit;
  std::vector<double> values;  // non-finite: missing
};

// Rows of all plots of a page. Lists are as long as `times_s`.
struct PageRows {
  std::vector<double> times_s;   // ascending
  std::vector<double> numbers;   // frame numbers; empty: the rows are not frames
  std::size_t every = 1;         // frames that a row represents; it holds the slowest of them
  double warmup_s = 0;           // shaded, and excluded from the distribution
  std::size_t timed_series = 1;  // number of series of the first plot that are frame times
  std::map<std::size_t, std::string> apart;     // by row: reason why statistics exclude its time
  std::map<std::size_t, std::string> pictures;  // by row: a file next to the page
  std::vector<RowFigure> figures;
  std::vector<RowFigure> parts;  // parts of a frame's time in ms: shown as bars, longest first
};

// The toolbar, which stays visible, and the panel of one row. Put before the plots.
std::string page_tools_html(const PageRows& rows);
// A figure element with the distribution of the first plot's times.
std::string distribution_html();

}  // namespace psygen::telemetry
