// Script of pages with plots over time. Draws the figures of report_plot.hpp over the rows of
// page_rows.hpp, all with one zoom. Shows the values under the pointer, the distribution of the
// visible frames, and one frame in detail. Plain JavaScript and SVG without external resources.
// Static storage; any thread.
#pragma once

#include <string_view>

namespace psygen::telemetry {

// Put it at the end of the page.
std::string_view page_script();

}  // namespace psygen::telemetry
