#include "editor/document/line_diff.hpp"

#include <gtest/gtest.h>

#include <random>

namespace psygen::editor {
namespace {

TEST(LineDiff, ShowsHunksWithTheirLines) {
  EXPECT_EQ(unified_diff("a\nb\nc\n", "a\nb\nc\n", "x", "y"), "");
  EXPECT_EQ(unified_diff("a\nb\nc\nd\ne\nf\n", "a\nb\nC\nd\ne\nf\n", "x", "y", 1),
            "--- x\n+++ y\n@@ -2,3 +2,3 @@\n b\n-c\n+C\n d\n");
  EXPECT_EQ(unified_diff("", "a\n", "x", "y"), "--- x\n+++ y\n@@ -0,0 +1,1 @@\n+a\n");
  EXPECT_EQ(unified_diff("a\n", "", "x", "y"), "--- x\n+++ y\n@@ -1,1 +0,0 @@\n-a\n");
  EXPECT_EQ(unified_diff("1\n2\n3\n4\n5\n6\n7\n8\n", "0\n1\n2\n3\n4\n5\n6\n7\n", "x", "y", 2),
            "--- x\n+++ y\n@@ -1,2 +1,3 @@\n+0\n 1\n 2\n@@ -6,3 +7,2 @@\n 6\n 7\n-8\n");
}

// Applies a diff.
std::string applied(const std::vector<DiffLine>& lines, DiffLine::Kind without) {
  std::string text;
  for (const DiffLine& line : lines)
    if (line.kind != without) text += std::string(line.text) + "\n";
  return text;
}

TEST(LineDiff, TransformsOneTextIntoTheOther) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 500; ++round) {
    std::string before, after;
    for (std::uint64_t i = random() % 20; i > 0; --i)
      before += std::string(1, static_cast<char>('a' + random() % 4)) + "\n";
    for (std::uint64_t i = random() % 20; i > 0; --i)
      after += std::string(1, static_cast<char>('a' + random() % 4)) + "\n";
    const auto lines = line_diff(before, after);
    EXPECT_EQ(applied(lines, DiffLine::Kind::kAdded), before);
    EXPECT_EQ(applied(lines, DiffLine::Kind::kRemoved), after);
  }
}

TEST(LineDiff, CountsAReplacedLineOnce) {
  EXPECT_EQ(changed_lines("a\nb\nc\n", "a\nb\nc\n"), 0U);
  EXPECT_EQ(changed_lines("a\nb\nc\n", "a\nx\nc\n"), 1U);
  EXPECT_EQ(changed_lines("a\nb\nc\n", "b\nc\nd\n"), 2U);
  EXPECT_EQ(changed_lines("", "a\nb\n"), 2U);
}

TEST(LineDiff, LargeTextsAreShownAsOneBlock) {
  std::string before = "same\n", after = before;
  for (int i = 0; i < 5000; ++i) {
    before += std::to_string(i) + "\n";
    after += std::to_string(-i) + "\n";
  }
  const auto lines = line_diff(before, after);
  EXPECT_EQ(lines.front().kind, DiffLine::Kind::kSame);
  EXPECT_EQ(applied(lines, DiffLine::Kind::kRemoved), after);
}

}  // namespace
}  // namespace psygen::editor
