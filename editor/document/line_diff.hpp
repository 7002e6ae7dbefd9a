// The lines in which two texts differ, as `diff -u` writes them, for "what will be saved". By the
// longest common subsequence of lines; texts that differ in very many lines are shown as one block.
// Pure, any thread. Time and memory are bounded by kMaxPairs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace psygen::editor {

// Largest product of the numbers of lines that differ.
inline constexpr std::size_t kMaxPairs = 4'000'000;

// A line with what happens to it.
struct DiffLine {
  enum class Kind { kSame, kRemoved, kAdded };
  Kind kind = Kind::kSame;
  std::string_view text;  // without its line break; of one of the two texts
};

// All lines of both texts, in order; removed ones before added ones.
std::vector<DiffLine> line_diff(std::string_view before, std::string_view after);

// "--- BEFORE", "+++ AFTER" and the hunks, each with `context` lines around it. Empty if the texts
// are equal. A missing line break at the end is not shown.
std::string unified_diff(std::string_view before, std::string_view after,
                         std::string_view before_name, std::string_view after_name,
                         std::size_t context = 3);

}  // namespace psygen::editor
