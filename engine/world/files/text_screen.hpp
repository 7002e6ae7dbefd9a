// Looks over the text of a file before the TOML parser does, and refuses what the parser could not
// take or could not name: bytes that are not UTF-8, characters beyond ASCII outside of strings and
// comments, strings over several lines, and keys of too many parts. Not a parser: it knows strings,
// comments and lines, and leaves all else to TOML. Pure; any thread.
#pragma once

#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::world {

// Fails with kParse, naming file, line and column (from 1, in characters), at the first such place.
// A byte order mark at the start is allowed. A dotted key may have at most `max_parts` parts.
core::Result<void> screen_text(std::string_view text, std::string_view file, int max_parts);

}  // namespace psygen::world
