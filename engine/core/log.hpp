// Messages for people, on stderr, one printable line each (utf8.hpp); data goes to stdout.
// Thread-safe. Format with fmt at the caller.
#pragma once

#include <string_view>

namespace psygen::core {

void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);
// Only warnings and errors from now on.
void set_log_quiet(bool quiet);

}  // namespace psygen::core
