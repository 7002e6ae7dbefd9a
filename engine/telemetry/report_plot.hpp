// One plot of a report: values over the flight's time as an SVG picture with axes, a legend and the
// data that its pointer read-out needs. Knows nothing of frames or figures. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::telemetry {

enum class PlotKind {
  kLine,     // the mean of each column with a band from its lowest to its highest value
  kPeaks,    // the highest value of each column, filled
  kStacked,  // means of the series on top of each other
};

struct PlotSeries {
  std::string name;
  int colour = 0;              // of the palette in report_style.cpp, 1 … 8; 0 and 9 are greys
  std::vector<double> values;  // one per entry of Plot::times_s; not finite: nothing is drawn
};

// A dashed horizontal line with a label right of it, just above or below its height.
struct PlotLevel {
  std::string label;
  double value = 0;
  bool label_below = false;
};

struct Plot {
  std::string title;
  std::string unit;  // "ms"; stands at the axis and behind values
  std::string note;  // a sentence below the plot; may be empty
  PlotKind kind = PlotKind::kLine;
  std::span<const double> times_s;  // ascending
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
  std::vector<double> marks_s;  // times that are marked below the drawing
  double warmup_s = 0;          // shaded from the start to here
  double top = 0;               // of the axis; 0 chooses it by the data. Higher values are cut off
};

// A <figure> element. All text is escaped.
std::string plot_html(const Plot& plot);

// Text with &, <, >, " and ' written as entities.
std::string escaped(std::string_view text);

}  // namespace psygen::telemetry
