// Mutates texts for fuzzing: code points of all planes at sensitive positions, split or invalid
// UTF-8, misplaced TOML punctuation, numbers at the ends of their ranges, lines of other files. The
// same random numbers give the same text. It follows no grammar, so most texts are invalid.
#pragma once

#include <random>
#include <span>
#include <string>

namespace psygen::fuzz {

// Returns `text` with one to eight changes and at most `max_bytes`. Lines are taken from `others`,
// which must not be empty.
std::string mutated(std::string text, std::span<const std::string> others, std::size_t max_bytes,
                    std::mt19937_64& random);

}  // namespace psygen::fuzz
