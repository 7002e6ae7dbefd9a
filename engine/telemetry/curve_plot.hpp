// A plot of values over a parameter as an SVG image: measured values as points, curves through them
// as lines, with axes and a legend. In the style of page_style.css. Plots over time are in
// page.hpp. Pure; linear in the values.
#pragma once

#include <string>
#include <vector>

namespace psygen::telemetry {

// Drawing style of a curve.
enum class CurveKind {
  kPoints,
  kLine,    // interrupted where a value is missing; a single value is a ring
  kDashed,  // as kLine, dashed
};

// One curve of a plot.
struct Curve {
  std::string name;
  int colour = 1;  // index into the palette, 1 … 8; 0 is grey
  CurveKind kind = CurveKind::kLine;
  std::vector<double> values;  // one per entry of CurvePlot::x; non-finite: missing
};

// A plot. The y axis starts at 0.
struct CurvePlot {
  std::string title;
  std::string x_name;     // label of the x axis
  std::string unit;       // of the y axis
  std::string note;       // text below the plot; may be empty
  std::vector<double> x;  // ascending
  std::vector<Curve> curves;
};

// Step between the ticks of an axis: 1, 2 or 5 times a power of ten, so that `range` has at most
// `steps` steps. Ranges below 1e-12 count as 1e-12.
double nice_step(double range, double steps);

// A <figure> element. All text is escaped.
std::string curve_plot_html(const CurvePlot& plot);

}  // namespace psygen::telemetry
