#include "engine/core/nearest_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace psygen::core {
namespace {

constexpr std::size_t kMaxBytes = 64;
constexpr std::size_t kMinBeginning = 3;

std::string_view letters_of(std::string_view word) {
  return word.substr(std::min(word.find_first_not_of('-'), word.size()));
}

// Optimal string alignment in bytes: Levenshtein's distance where a swap of neighbours is one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  using Row = std::array<std::size_t, kMaxBytes + 1>;
  Row two_above{}, above{}, row{};
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_above = above;
    above = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), row[j - 1] + 1, above[j] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::vector<std::string_view> views_of(std::span<const std::string> words) {
  return {words.begin(), words.end()};
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
  word = letters_of(word);
  if (word.size() > kMaxBytes) return {};
  std::string_view nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    const std::string_view letters = letters_of(candidate);
    if (letters.size() > kMaxBytes) continue;
    const bool begun = word.size() >= kMinBeginning && letters.starts_with(word);
    const std::size_t edits = edit_distance(word, letters);
    const std::size_t distance = begun ? std::min<std::size_t>(edits, 1) : edits;
    if (distance < fewest) {
      fewest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string_view nearest_word(std::string_view word, std::span<const std::string> known) {
  return nearest_word(word, views_of(known));
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_word(word, known);
  return nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest);
}

std::string suggestion(std::string_view word, std::span<const std::string> known) {
  return suggestion(word, views_of(known));
}

}  // namespace psygen::core
