// UTF-8: the code points of a text, and untrusted text made safe for any terminal. Not a table of
// character properties: {fmt} decides which characters are printable. Pure; any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace psygen::core {

// One decoded character, or one byte that is not UTF-8.
struct CodePoint {
  char32_t value = 0;     // the byte itself if it is not UTF-8
  std::size_t bytes = 1;  // length in the text
  bool valid = false;     // RFC 3629: no overlong forms, no surrogates
};

// Returns the first code point of `text`, which must not be empty. O(1).
CodePoint first_code_point(std::string_view text);

// Appends a code point as UTF-8. An invalid value (a surrogate, above U+10FFFF) becomes U+FFFD.
void append_utf8(std::string& text, char32_t value);

// Returns the text as one line of valid UTF-8. Control characters, invisible characters, characters
// that change the direction of the text, and bytes that are not UTF-8 become escapes such as \n,
// \x1b and \u202e. A text of more than `max_bytes` bytes is cut and ends in "...". O(bytes).
std::string shown(std::string_view text, std::size_t max_bytes = std::string_view::npos);

// Returns the text with small letters in place of the capital ones of ASCII.
std::string lower_ascii(std::string_view text);

}  // namespace psygen::core
