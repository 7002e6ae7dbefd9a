// Memory of this process as the operating system counts it. Not the engine's own count (cache,
// pools). Linux. Any thread; each call reads a file.
#pragma once

#include <cstdint>

#include "engine/telemetry/measured.hpp"

namespace psygen::telemetry {

// The largest resident set so far, in bytes. Missing when /proc cannot be read.
Measured<std::uint64_t> peak_rss_bytes();

}  // namespace psygen::telemetry
