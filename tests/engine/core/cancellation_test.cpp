// Cancellation of a thread's work.
#include "engine/core/cancellation.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

namespace psygen::core {
namespace {

TEST(Cancellation, EndsTheWorkOfTheThreadThatBoundTheFlag) {
  std::atomic<bool> flag{false};
  EXPECT_EQ(cancel_flag(), nullptr);
  {
    const CancelScope scope(&flag);
    EXPECT_EQ(cancel_flag(), &flag);
    EXPECT_TRUE(check_cancelled());
    flag = true;
    EXPECT_TRUE(is_cancelled());
    EXPECT_EQ(check_cancelled().error().code, ErrorCode::kInterrupted);
    bool elsewhere = true;
    std::thread([&] { elsewhere = is_cancelled(); }).join();
    EXPECT_FALSE(elsewhere);
  }
  EXPECT_FALSE(is_cancelled());
}

TEST(Cancellation, KeepsTheOuterFlagInScopesWithoutOne) {
  std::atomic<bool> outer{true}, inner{false};
  const CancelScope scope(&outer);
  {
    const CancelScope none(nullptr);
    EXPECT_TRUE(is_cancelled());
    const CancelScope other(&inner);
    EXPECT_FALSE(is_cancelled());
  }
  EXPECT_TRUE(is_cancelled());
}

TEST(Progress, IsReportedToTheInnermostScopeOfTheThread) {
  double outer = -1, inner = -1;
  report_progress(0.1);
  const ProgressScope scope([&](double part) { outer = part; });
  {
    const ProgressScope other([&](double part) { inner = part; });
    report_progress(0.2);
  }
  EXPECT_EQ(inner, 0.2);
  EXPECT_EQ(outer, -1);
  report_progress(0.3);
  std::thread([] { report_progress(0.4); }).join();
  EXPECT_EQ(outer, 0.3);
  {
    const ProgressScope none({});
    report_progress(0.5);
    const ProgressScope failing([](double) { throw std::runtime_error("no display"); });
    EXPECT_NO_THROW(report_progress(0.6));
  }
  EXPECT_EQ(outer, 0.3);
}

}  // namespace
}  // namespace psygen::core
