#include "engine/telemetry/process_memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace psygen::telemetry {
namespace {

TEST(ProcessMemory, PeakGrowsWithTouchedMemoryAndIsNeverBelowThePresent) {
  ASSERT_TRUE(peak_rss_bytes().has_value());
  const std::uint64_t before = *current_rss_bytes();
  std::vector<char> block(64 << 20, 1);
  block[before % block.size()] = 2;
  EXPECT_GE(*current_rss_bytes(), before + (48 << 20));
  EXPECT_GE(*peak_rss_bytes(), before + (48 << 20));
  EXPECT_GT(block[before % block.size()], 1);
}

}  // namespace
}  // namespace psygen::telemetry
