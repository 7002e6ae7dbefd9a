#include "engine/telemetry/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace psygen::telemetry {
namespace {

TEST(ProcessCommand, HasTheNameOfThisProgram) {
  EXPECT_THAT(process_command(), testing::HasSubstr("psygen_test_telemetry"));
}

TEST(ProcessCommand, CanBeTypedIntoAShell) {
  const std::string words("psygen\0fly\0--out\0a b\0it's\0\0$(x)\0", 31);
  EXPECT_EQ(shell_text(words), "psygen fly --out 'a b' 'it'\\''s' '' '$(x)'");
  EXPECT_EQ(shell_text(""), "");
}

TEST(ProcessCommand, AcceptsALastWordWithoutAnEnd) {
  EXPECT_EQ(shell_text("a"), "a");
}

TEST(ProcessMemory, ThePeakGrowsWithTouchedMemoryAndNeverShrinks) {
  ASSERT_TRUE(peak_rss_bytes().has_value());
  const std::uint64_t before = *peak_rss_bytes();
  {
    // More than any memory that was freed since the last peak.
    std::vector<char> block(before + (64 << 20), 1);
    block[before % block.size()] = 2;
    EXPECT_GE(*peak_rss_bytes(), before + (48 << 20));
    EXPECT_GT(block[before % block.size()], 1);
  }
  EXPECT_GE(*peak_rss_bytes(), before + (48 << 20));
}

TEST(ProcessMemory, APeakCanBeForgotten) {
  const std::uint64_t before = *peak_rss_bytes();
  {
    std::vector<char> block(before + (64 << 20), 1);
    EXPECT_GT(block[before % block.size()], 0);
  }
  forget_peak_rss();
  EXPECT_LT(*peak_rss_bytes(), before + (48 << 20));
}

}  // namespace
}  // namespace psygen::telemetry
