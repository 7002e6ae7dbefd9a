// UTF-8: the code points of a text, and texts of strangers as any terminal shows them. Not a table
// of properties: which characters can be printed is what {fmt} knows. Pure; any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace psygen::core {

struct CodePoint {
  char32_t value = 0;     // of what is not UTF-8 the byte itself
  std::size_t bytes = 1;  // that it takes
  bool valid = false;     // RFC 3629: nothing longer than it must be, no surrogates
};

// The first code point of `text`, which must not be empty.
CodePoint first_code_point(std::string_view text);

// One line that is valid UTF-8: control characters, invisible ones, those that turn the direction
// of the text, and bytes that are no UTF-8 become escapes such as \n, \x1b and \u202e. A text of
// more than `most_bytes` is cut, and ends in "...".
std::string shown(std::string_view text, std::size_t most_bytes = std::string_view::npos);

}  // namespace psygen::core
