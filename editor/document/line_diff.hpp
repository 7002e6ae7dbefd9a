// The lines in which two texts differ, in the format of `diff -u`, for the list of unsaved changes.
// Uses the longest common subsequence of lines; if very many lines differ, they become one block.
// Pure; any thread. kMaxPairs bounds time and memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::editor {

// Maximum product of the numbers of differing lines of both texts.
inline constexpr std::size_t kMaxPairs = 4'000'000;

// A line that is in both texts, or only in the first or the second one.
struct DiffLine {
  enum class Kind { kSame, kRemoved, kAdded };
  Kind kind = Kind::kSame;
  std::string_view text;  // without its line break; of one of the two texts
};

// All lines of both texts, in order; removed ones before added ones.
std::vector<DiffLine> line_diff(std::string_view before, std::string_view after);

// The number of changed lines; a line replaced by another one counts once.
std::size_t changed_lines(std::string_view before, std::string_view after);

// "--- BEFORE", "+++ AFTER" and the hunks, each with `context` lines around it. Empty if the texts
// are equal. A missing line break at the end is not shown.
std::string unified_diff(std::string_view before, std::string_view after,
                         std::string_view before_name, std::string_view after_name,
                         std::size_t context = 3);

}  // namespace psygen::editor
