// Style of pages, as text to embed. Static storage; any thread.
#pragma once

#include <string_view>

namespace psygen::telemetry {

// CSS with a palette of eight colours and two greys (fill0 … fill9, stroke0 …, swatch0 …), for
// light and dark themes.
std::string_view page_style();

}  // namespace psygen::telemetry
