// Time. Seconds as doubles: a monotonic clock, the CPU time of the calling thread, a timer of short
// times over both, and a stopwatch over the latter that tests can make virtual. Not calendar time. POSIX; any thread.
#pragma once

#include <algorithm>

namespace psygen::core {

// Seconds since an arbitrary start that is fixed while the system runs; never goes back.
double monotonic_seconds();
// Seconds since some start in which the machine was suspended; monotonic_seconds() does not count
// them. Two readings differ by microseconds where it was not.
double suspended_seconds();
// Seconds of processor time that the calling thread has used.
double thread_cpu_seconds();

// Seconds of processor time that the calling thread has used since the timer was made, for times of
// microseconds. Reading thread_cpu_seconds() is a system call of about 1 µs that counts itself;
// reading monotonic_seconds() takes 40 ns, but counts what other threads take. The less of both is
// nearer to the truth. Read it on the thread that made it.
class CpuTimer {
 public:
  CpuTimer() : cpu_start_s_(thread_cpu_seconds()), start_s_(monotonic_seconds()) {}
  double seconds() const {
    const double elapsed_s = monotonic_seconds() - start_s_;
    return std::min(elapsed_s, thread_cpu_seconds() - cpu_start_s_);
  }

 private:
  double cpu_start_s_, start_s_;
};

// Seconds that the calling thread has used since the stopwatch was made. A real stopwatch measures
// the thread's CPU time, so time that other threads take does not count. A virtual one returns the
// seconds that it was charged with. Read it on the thread that made it.
class Stopwatch {
 public:
  // Starts at 0.
  explicit Stopwatch(bool is_virtual = false)
      : is_virtual_(is_virtual), start_s_(is_virtual ? 0.0 : thread_cpu_seconds()) {}
  // Adds to a virtual stopwatch; a real one measures by itself and ignores this.
  void charge(double seconds) { charged_s_ += seconds; }
  // Seconds since the start.
  double seconds() const { return is_virtual_ ? charged_s_ : thread_cpu_seconds() - start_s_; }

 private:
  bool is_virtual_;
  double start_s_, charged_s_ = 0;
};

}  // namespace psygen::core
