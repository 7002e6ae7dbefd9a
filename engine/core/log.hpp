// Messages for people, on stderr, one printable line each (utf8.hpp). Data goes to stdout instead.
// Thread-safe. Callers format with fmt.
#pragma once

#include <string_view>

namespace psygen::core {

// Writes one line with its level. Unprintable characters are escaped.
void log_info(std::string_view message);
void log_warning(std::string_view message);
void log_error(std::string_view message);

}  // namespace psygen::core
