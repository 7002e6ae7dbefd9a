#include "engine/telemetry/process_memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace psygen::telemetry {
namespace {

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

}  // namespace
}  // namespace psygen::telemetry
