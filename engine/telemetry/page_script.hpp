// The script of pages with plots over time: it draws the figures of report_plot.hpp over the rows
// of page_rows.hpp, all with one zoom; shows the values under the pointer, the distribution of what
// is in view, and one frame whole. Plain JavaScript and SVG, nothing from outside. Static storage;
// any thread.
#pragma once

#include <string_view>

namespace psygen::telemetry {

// To be put at the end of the page.
std::string_view page_script();

}  // namespace psygen::telemetry
