// The style and the script of report.html, as text to put into the page. Static storage; any
// thread.
#pragma once

#include <string_view>

namespace psygen::telemetry {

// CSS with a palette of eight colours (fill1 … fill8, stroke1 …, swatch1 …) in light and dark.
std::string_view report_style();

// Shows the values of a plot under the pointer. Plain JavaScript, no dependencies.
std::string_view report_script();

}  // namespace psygen::telemetry
