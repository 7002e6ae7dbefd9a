// Memory of this process as the operating system counts it, unlike the engine's own counts (cache,
// pools). Linux. Any thread; each call reads a file.
#pragma once

#include <cstdint>

#include "engine/telemetry/measured.hpp"

namespace psygen::telemetry {

// Largest resident set so far, in bytes. Missing if /proc cannot be read.
Measured<std::uint64_t> peak_rss_bytes();

}  // namespace psygen::telemetry
