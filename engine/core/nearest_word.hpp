// Finds the word that a misspelt key of a file, command or option probably means. Not a spelling
// checker: it compares with the given words. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace psygen::core {

// Returns the word of `known` that needs the fewest edits to become `word`; the first of several.
// An edit adds, removes or replaces a letter, or swaps two neighbours. A word that begins with
// `word` (three letters or more) is one edit away. Empty if no word is within a third of the
// letters of `word` (at least one edit); leading dashes do not count as letters. The result is a
// view into `known`. O(letters of `word` · letters of `known`). Words over 64 bytes match nothing.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);
std::string_view nearest_word(std::string_view word, std::span<const std::string> known);

// The end of a message: "; did you mean count?", or empty if no word is near.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);
std::string suggestion(std::string_view word, std::span<const std::string> known);

}  // namespace psygen::core
