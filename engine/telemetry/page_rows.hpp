// What a page knows of every row of its plots, of a flight's frames or of those of a comparison.
// The page's script zooms over them, shows their values, and one of them whole. Pure; linear in
// rows.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "engine/telemetry/report_plot.hpp"

namespace psygen::telemetry {

// A figure of every row that no plot has.
struct RowFigure {
  std::string name, unit;
  std::vector<double> values;  // not finite: no value
};

// The rows of all plots of a page. Lists are as long as `times_s`.
struct PageRows {
  std::vector<double> times_s;   // ascending
  std::vector<double> numbers;   // of the frames; empty: the rows are not frames
  std::size_t every = 1;         // frames that a row stands for; it is the slowest of them
  double warmup_s = 0;           // shaded, and not in the distribution
  std::size_t timed_series = 1;  // so many series of the first plot are frame times
  std::map<std::size_t, std::string> apart;     // by row: why its time is in no figure
  std::map<std::size_t, std::string> pictures;  // by row: a file beside the page
  std::vector<RowFigure> figures;
  std::vector<RowFigure> parts;  // of a frame's time, in ms: shown as bars, longest first
};

// The toolbar, which stays in view, and the panel of one row. Before the plots.
std::string page_tools_html(const PageRows& rows);
// The figure of the distribution of the first plot's times.
std::string distribution_html();

}  // namespace psygen::telemetry
