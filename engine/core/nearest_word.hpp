// What somebody may have meant who misspelt a word: a key of a file, a command, an option. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace psygen::core {

// The one of `known` that needs the fewest changes to become `word`, if it is near: at most a third
// of the letters, or two. Else empty.
std::string_view nearest_word(std::string_view word, std::span<const std::string> known);

}  // namespace psygen::core
