// One plot of a page: values over time, as a figure whose data the page's script (page_script.hpp)
// draws. Knows nothing of frames or figures. Pure; linear in the values.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

// How the series of a plot are drawn. Where several rows share a pixel:
enum class PlotKind : std::uint8_t {
  kLine,     // their mean, with a band from the lowest to the highest value
  kPeaks,    // the highest value, filled
  kStacked,  // means of the series stacked on each other
};

// One quantity over time.
struct PlotSeries {
  std::string name;
  int colour = 0;              // of the palette in page_style.cpp, 1 … 8; 0 and 9 are greys
  std::vector<double> values;  // one per row of the page; not finite: no value
};

// A dashed horizontal line with a label at its right end, just above or below its height.
struct PlotLevel {
  std::string label;
  double value = 0;
  bool label_below = false;
};

// What is drawn.
struct Plot {
  std::string title;
  std::string unit;  // "ms"; at the axis and after values
  std::string note;  // a sentence below the plot; may be empty
  PlotKind kind = PlotKind::kLine;
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
  double top = 0;      // of the axis, higher values are cut off; 0: from the data
  bool zooms = true;   // the axis follows what a zoomed plot shows; else `top` stays
  bool small = false;  // half as high as others
};

// A <figure> element. All text is escaped.
std::string plot_html(const Plot& plot);

// The step between the ticks of an axis: 1, 2 or 5 times a power of ten, such that `range` has at
// most `steps` steps. Ranges below 1e-12 count as 1e-12.
double nice_step(double range, double steps);

// The text with &, <, >, " and ' written as entities.
std::string escaped(std::string_view text);

// Of JSON inside of a <script>: a text with its quotes, in which no tag can begin, and a list of
// numbers with six digits. Numbers that are not finite are null.
std::string json_text(std::string_view text);
std::string json_numbers(std::span<const double> values);

}  // namespace psygen::telemetry
