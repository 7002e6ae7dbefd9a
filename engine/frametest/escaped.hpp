// Escapes texts of tests for HTML and XML. Any thread.
#pragma once

#include <string>
#include <string_view>

#include "engine/core/utf8.hpp"
#include "engine/telemetry/report_plot.hpp"

namespace psygen::frametest {

// shown() leaves no control characters, which XML cannot represent.
inline std::string escaped(std::string_view text) {
  return telemetry::escaped(core::shown(text));
}

}  // namespace psygen::frametest
