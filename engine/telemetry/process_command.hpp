// Command line of this process, for readers of a report. Not for programs to parse. Linux. Any
// thread; each call reads a file.
#pragma once

#include <string>
#include <string_view>

namespace psygen::telemetry {

// The program and its arguments as typed into a shell, at most 2,000 bytes. Empty if /proc cannot
// be read.
std::string process_command();

// Formats zero-terminated words, as /proc stores them.
std::string shell_text(std::string_view words);

}  // namespace psygen::telemetry
