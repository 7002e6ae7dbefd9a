// One plot of a page: values over time, as a figure element whose data the page's script
// (page_script.js) draws. Independent of frames. Pure; linear in the values.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

// Drawing style of a plot's series. If several rows share a pixel:
enum class PlotKind : std::uint8_t {
  kLine,     // their mean, with a band from minimum to maximum
  kPeaks,    // the maximum, filled
  kStacked,  // means of the series, stacked
};

// One quantity over time.
struct PlotSeries {
  std::string name;
  int colour = 0;              // palette index of page_style.css, 1 … 8; 0 and 9 are greys
  std::vector<double> values;  // one per row of the page; non-finite: missing
};

// A dashed horizontal line with a label at its right end, just above or below it.
struct PlotLevel {
  std::string label;
  double value = 0;
  bool label_below = false;
};

// A plot.
struct Plot {
  std::string title = {};
  std::string unit = {};  // at the axis and after values
  std::string note = {};  // text below the plot; may be empty
  PlotKind kind = PlotKind::kLine;
  std::vector<PlotSeries> series = {};
  std::vector<PlotLevel> levels = {};
  double top = 0;      // upper end of the axis, higher values are cut off; 0: from the data
  bool zooms = true;   // the axis follows the zoomed range; otherwise `top` stays
  bool small = false;  // half the height of other plots
};

// A <figure> element. All text is escaped.
std::string plot_html(const Plot& plot);

// Step between the ticks of an axis: 1, 2 or 5 times a power of ten, so that `range` has at most
// `steps` steps. Ranges below 1e-12 count as 1e-12.
double nice_step(double range, double steps);

// Escapes &, <, >, " and ' as entities.
std::string escaped(std::string_view text);

// JSON for a <script> element: a quoted text that cannot start a tag, and a list of numbers with
// six digits. Non-finite numbers are null.
std::string json_text(std::string_view text);
std::string json_numbers(std::span<const double> values);

}  // namespace psygen::telemetry
