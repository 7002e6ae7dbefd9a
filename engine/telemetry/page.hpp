// Pages with plots over time: style and script as texts to embed, figures whose data the script
// draws, and the rows behind the plots, which are frames of a flight or of a comparison. The script
// zooms over the rows, shows their values, and one row in detail. Pure; linear in rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

// page_style.css: a palette of eight colours and two greys (fill0 … fill9, stroke0 …, swatch0 …),
// for light and dark themes.
std::string_view page_style();

// page_script.js, for pages with plots over time. Draws the figures of plot_html() over the rows of
// PageRows, all with one zoom. Shows the values under the pointer, the distribution of the visible
// frames, and one frame in detail. Plain JavaScript and SVG without external resources.
std::string_view page_script();

// A whole page with page_style(). `title` is plain text; `body` is HTML; `style` and `script`,
// which may be empty, are added as they are.
std::string page_html(std::string_view title, std::string_view style, std::string_view body,
                      std::string_view script = {});

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

// Escapes &, <, >, " and ' as entities.
std::string escaped(std::string_view text);

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
  std::map<std::size_t, std::string> marks;     // by row: the name of a vertical line
  std::vector<RowFigure> figures;
  std::vector<RowFigure> parts;  // parts of a frame's time in ms: shown as bars, longest first
};

// The toolbar, which stays visible, and the panel of one row. Put before the plots.
std::string page_tools_html(const PageRows& rows);
// A figure element with the distribution of the first plot's times.
std::string distribution_html();

}  // namespace psygen::telemetry
