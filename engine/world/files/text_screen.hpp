// Screens the text of a file before the TOML parser reads it. Rejects texts that the parser cannot
// handle or describe well: bytes that are not UTF-8, non-ASCII characters outside strings and
// comments, strings over several lines, and dotted keys with too many parts. Not a parser: it knows
// only strings, comments and lines. Pure, any thread, linear in the text.
#pragma once

#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::world {

// Fails with kParse at the first violation, naming file, line and column (from 1, in characters). A
// byte order mark at the start is allowed. A dotted key may have at most `max_parts` parts.
core::Result<void> screen_text(std::string_view text, std::string_view file, int max_parts);

}  // namespace psygen::world
