// Facts about this process that the operating system knows: its command line, and its memory,
// unlike the engine's own counts (cache, pools). For readers of a report, not for programs to
// parse. Linux. Any thread; each call reads a file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {

// The program and its arguments as typed into a shell, at most 2,000 bytes. Empty if /proc cannot
// be read.
std::string process_command();

// Formats zero-terminated words, as /proc stores them.
std::string shell_text(std::string_view words);

// Largest resident set so far, in bytes. Missing if /proc cannot be read.
Measured<std::uint64_t> peak_rss_bytes();
// Makes peak_rss_bytes() count from now on. Does nothing if the kernel does not offer it.
void forget_peak_rss();

}  // namespace psygen::telemetry
