#include "engine/core/clock.hpp"

#include <ctime>

namespace psygen::core {
namespace {
double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}
}  // namespace

double monotonic_seconds() {
  return seconds_of(CLOCK_MONOTONIC);
}
double suspended_seconds() {
  return seconds_of(CLOCK_BOOTTIME) - seconds_of(CLOCK_MONOTONIC);
}
double thread_cpu_seconds() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace psygen::core
