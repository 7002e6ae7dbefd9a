#include "engine/core/headroom.hpp"

#include <gtest/gtest.h>

#include "engine/core/out_of_memory.hpp"
#include "tests/faults.hpp"

namespace psygen::core {
namespace {

TEST(Headroom, CountsThreadsUpToTheRequest) {
  EXPECT_EQ(threads_left(0), 0u);
  EXPECT_EQ(threads_left(5), 5u);
  const FewThreads few(3);
  EXPECT_EQ(threads_left(5), 3u);
  EXPECT_EQ(threads_left(5), 0u) << "the counted threads return to the system, not to the fault";
}

TEST(Headroom, ReportsThatNoMachineHasAnExabyte) {
  EXPECT_TRUE(memory_left(1 << 20));
  EXPECT_TRUE(addresses_left(1 << 20));
  constexpr std::uint64_t kTooMuch = std::uint64_t{1} << 60;
  EXPECT_FALSE(addresses_left(kTooMuch));
  EXPECT_FALSE(memory_left(kTooMuch));
  EXPECT_NE(out_of_memory("a test").find("1099511627776 MiB more were wanted"), std::string::npos)
      << out_of_memory("a test");
}

}  // namespace
}  // namespace psygen::core
