#include "engine/core/clock.hpp"

#include <windows.h>

#include <cstdint>

namespace psygen::core {
namespace {

constexpr double kTickSeconds = 1e-7;  // the unit of Windows's times

double seconds_of(const FILETIME& time) {
  return static_cast<double>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime) *
         kTickSeconds;
}

}  // namespace

double monotonic_seconds() {
  LARGE_INTEGER now{}, per_second{};
  QueryPerformanceCounter(&now);
  QueryPerformanceFrequency(&per_second);
  return static_cast<double>(now.QuadPart) / static_cast<double>(per_second.QuadPart);
}

// Windows's unbiased time leaves out suspensions; its tick count has them, in steps of 16 ms.
double suspended_seconds() {
  ULONGLONG unbiased = 0;
  QueryUnbiasedInterruptTime(&unbiased);
  return static_cast<double>(GetTickCount64()) * 1e-3 -
         static_cast<double>(unbiased) * kTickSeconds;
}

double thread_cpu_seconds() {
  FILETIME made{}, ended{}, kernel{}, user{};
  GetThreadTimes(GetCurrentThread(), &made, &ended, &kernel, &user);
  return seconds_of(kernel) + seconds_of(user);
}

}  // namespace psygen::core
