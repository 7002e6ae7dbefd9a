#include "engine/core/clock.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace psygen::core {
namespace {

void burn(double seconds) {
  const double start_s = thread_cpu_seconds();
  while (thread_cpu_seconds() - start_s < seconds) {
  }
}

TEST(Stopwatch, CountsTheTimeOfItsOwnThread) {
  const Stopwatch stopwatch;
  std::thread(burn, 0.02).join();
  const double while_it_waited_s = stopwatch.seconds();
  EXPECT_LT(while_it_waited_s, 0.02);
  burn(0.005);
  EXPECT_GE(stopwatch.seconds() - while_it_waited_s, 0.005);
}

TEST(Stopwatch, OfVirtualTimeShowsTheChargedSeconds) {
  Stopwatch stopwatch(true);
  burn(0.001);
  EXPECT_EQ(stopwatch.seconds(), 0.0);
  stopwatch.charge(0.25);
  stopwatch.charge(0.5);
  EXPECT_EQ(stopwatch.seconds(), 0.75);
}

}  // namespace
}  // namespace psygen::core
