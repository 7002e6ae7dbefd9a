// Memory of this process as the operating system counts it. Linux.
#pragma once

#include <cstdint>

#include "engine/telemetry/measured.hpp"

namespace psygen::telemetry {

// Largest and present resident set in bytes. Missing where /proc cannot be read.
Measured<std::uint64_t> peak_rss_bytes();
Measured<std::uint64_t> current_rss_bytes();

}  // namespace psygen::telemetry
