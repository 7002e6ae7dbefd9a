// What a misspelt word was probably meant to be: a key of a file, a command, an option. Not a
// spelling checker: it compares with the words given. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace psygen::core {

// The word of `known` that the fewest edits turn into `word`; the first of several. An edit adds,
// removes or replaces a letter, or swaps two neighbours; a word that begins with `word`, of three
// letters or more, is one edit away. Empty when none is within a third of the letters of `word`,
// one at least; dashes in front are not letters. A view into `known`. O(letters of `word` * letters
// of `known`); words over 64 bytes match nothing.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);
std::string_view nearest_word(std::string_view word, std::span<const std::string> known);

// For the end of a message: "; did you mean count?", or nothing where no word is near.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);
std::string suggestion(std::string_view word, std::span<const std::string> known);

}  // namespace psygen::core
