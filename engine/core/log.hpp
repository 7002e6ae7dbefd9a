// Messages for people, on stderr, one printable line each (utf8.hpp). Data goes to stdout instead.
// Thread-safe. Callers format with fmt.
#pragma once

#include <string_view>

namespace psygen::core {

// Names the program that messages begin with; "psygen" by default. Call it before other threads
// log.
void set_log_name(std::string_view name);

// Writes one line with its level. Unprintable characters are escaped.
void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

}  // namespace psygen::core
