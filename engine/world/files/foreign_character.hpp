// Names characters beyond ASCII that stand where only ASCII may: as people see them, by number, and
// those that are easily mistaken for ASCII, or cannot be seen, in words. Pure; any thread.
#pragma once

#include <string>

#include "engine/core/utf8.hpp"

namespace psygen::world {

struct ForeignCharacter {
  std::string name;    // "'ö' (U+00F6)", "U+200B (an invisible space)"
  std::string advice;  // what to do about it: "write -"; empty for most
};

// `bytes` are those of the code point.
ForeignCharacter describe(const core::CodePoint& point, std::string_view bytes);

}  // namespace psygen::world
