// Changes texts as a fuzzer wants them: code points of all planes where they hurt, UTF-8 that is
// split or wrong, TOML's own marks in wrong places, numbers at the ends of their ranges, lines of
// other files. The same random numbers make the same text. Not a grammar: most texts are broken.
#pragma once

#include <random>
#include <span>
#include <string>

namespace psygen::fuzz {

// `text` with one to eight changes, of at most `most_bytes`. `others` are texts to take lines from;
// there is at least one.
std::string mutated(std::string text, std::span<const std::string> others, std::size_t most_bytes,
                    std::mt19937_64& random);

}  // namespace psygen::fuzz
