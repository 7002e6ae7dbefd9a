// A plot of values over a parameter as an SVG picture: measured values as points, curves through
// them as lines, with axes and a legend. In the style of page_style.cpp. Not for values over
// time: report_plot.hpp draws those. Pure; linear in the values.
#pragma once

#include <string>
#include <vector>

namespace psygen::telemetry {

// How a curve is drawn.
enum class CurveKind {
  kPoints,
  kLine,    // breaks where there is no value; a value without neighbours is a ring
  kDashed,  // likewise, dashed
};

// One set of values of a plot.
struct Curve {
  std::string name;
  int colour = 1;  // of the palette, 1 … 8; 0 is grey
  CurveKind kind = CurveKind::kLine;
  std::vector<double> values;  // one per entry of CurvePlot::x; not finite: no value
};

// What is drawn. The y axis starts at 0.
struct CurvePlot {
  std::string title;
  std::string x_name;     // label of the x axis
  std::string unit;       // of the values
  std::string note;       // a sentence below the plot; may be empty
  std::vector<double> x;  // ascending
  std::vector<Curve> curves;
};

// A <figure> element. All text is escaped.
std::string curve_plot_html(const CurvePlot& plot);

}  // namespace psygen::telemetry
