// Describes non-ASCII characters where only ASCII is allowed: the glyph, the number, and a
// description in words for characters that are invisible or easily mistaken for ASCII. It does not
// find them (text_screen.hpp). Pure, any thread.
#pragma once

#include <string>

#include "engine/core/utf8.hpp"

namespace psygen::world {

// A description for an error message.
struct ForeignCharacter {
  std::string name;    // "'ö' (U+00F6)", "U+200B (an invisible space)"
  std::string advice;  // how to correct it: "write -"; empty for most
};

// Describes a code point. `bytes` is its UTF-8 text.
ForeignCharacter describe(const core::CodePoint& point, std::string_view bytes);

}  // namespace psygen::world
