// The style and the script of pages, as texts to embed. Static storage; any thread.
#pragma once

#include <string_view>

namespace psygen::telemetry {

// page_style.css: a palette of eight colours and two greys (fill0 … fill9, stroke0 …, swatch0 …),
// for light and dark themes.
std::string_view page_style();

// page_script.js, for pages with plots over time; put it at the end of the page. Draws the figures
// of report_plot.hpp over the rows of page_rows.hpp, all with one zoom. Shows the values under the
// pointer, the distribution of the visible frames, and one frame in detail. Plain JavaScript and
// SVG without external resources.
std::string_view page_script();

}  // namespace psygen::telemetry
