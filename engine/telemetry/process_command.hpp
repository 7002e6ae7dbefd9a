// The command line of this process, for people who read a report. Not for programs to parse. Linux.
// Any thread; each call reads a file.
#pragma once

#include <string>
#include <string_view>

namespace psygen::telemetry {

// The program and its arguments as they would be typed into a shell, at most 2,000 bytes of them.
// Empty when /proc cannot be read.
std::string process_command();

// The same of words that each end in a zero byte, as /proc has them.
std::string shell_text(std::string_view words);

}  // namespace psygen::telemetry
