// Messages for people, on stderr, one printable line each (utf8.hpp). Data goes to stdout instead.
// The last lines are kept for reports of crashes. Thread-safe. Callers format with fmt.
#pragma once

#include <cstddef>
#include <string_view>

namespace psygen::core {

// Names the program that messages begin with; "psygen" by default. Call it before other threads
// log.
void set_log_name(std::string_view name);

// Writes one line with its level. Unprintable characters are escaped.
void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

// Number of lines that are kept, and their length in bytes; longer ones are cut.
inline constexpr std::size_t kKeptLogLines = 64, kKeptLogLineBytes = 240;
// Writes the last kKeptLogLines lines to a file descriptor, oldest first, each with a line feed.
// Async-signal-safe after the first call of set_log_name(); a line that another thread logs
// meanwhile may be mixed with an older one. Returns false if they cannot be written.
bool write_kept_log_lines(int descriptor);

}  // namespace psygen::core
