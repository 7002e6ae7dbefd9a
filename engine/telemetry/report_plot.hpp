// One plot of a report: values over the flight's time as an SVG picture with axes, a legend and the
// data for its read-out under the pointer. Knows nothing of frames or figures. Pure; linear in the
// values.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

// How the series of a plot are drawn.
enum class PlotKind {
  kLine,     // the mean of each column with a band from its lowest to its highest value
  kPeaks,    // the highest value of each column, filled
  kStacked,  // means of the series stacked on each other
};

// One quantity over time.
struct PlotSeries {
  std::string name;
  int colour = 0;              // of the palette in report_style.cpp, 1 … 8; 0 and 9 are greys
  std::vector<double> values;  // one per entry of Plot::times_s; not finite: no value
};

// A dashed horizontal line with a label to its right, just above or below its height.
struct PlotLevel {
  std::string label;
  double value = 0;
  bool label_below = false;
};

// What is drawn. `times_s` must stay valid during the call.
struct Plot {
  std::string title;
  std::string unit;  // "ms"; at the axis and after values
  std::string note;  // a sentence below the plot; may be empty
  PlotKind kind = PlotKind::kLine;
  std::span<const double> times_s;  // ascending
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
  std::vector<double> marks_s;  // times marked below the drawing
  double warmup_s = 0;          // shaded from the start to this time
  double top = 0;               // of the axis, higher values are cut off; 0: from the data
};

// A <figure> element. All text is escaped. At most 900 columns are drawn.
std::string plot_html(const Plot& plot);

// The step between the ticks of an axis: 1, 2 or 5 times a power of ten, such that `range` has at
// most `steps` steps. Ranges below 1e-12 count as 1e-12.
double nice_step(double range, double steps);

// The text with &, <, >, " and ' written as entities.
std::string escaped(std::string_view text);

}  // namespace psygen::telemetry
