// Time. Seconds as doubles: a monotonic clock, the CPU time of the calling thread, and a stopwatch
// over the latter that tests can make virtual. Not calendar time. POSIX; any thread.
#pragma once

namespace psygen::core {

// Seconds since an arbitrary start that is fixed while the system runs; never goes back.
double monotonic_seconds();
// Seconds since an arbitrary start that the machine spent suspended; monotonic_seconds() does not
// count them. Without a suspension, two readings differ by microseconds.
double suspended_seconds();
// Processor time that the calling thread has used, in seconds.
double thread_cpu_seconds();

// Seconds that the calling thread has used since the stopwatch was made. A real stopwatch measures
// the thread's CPU time, so the time of other threads does not count. A virtual one returns the sum
// of the seconds passed to charge(). Read it on the thread that made it.
class Stopwatch {
 public:
  // Starts at 0.
  explicit Stopwatch(bool is_virtual = false)
      : is_virtual_(is_virtual), start_s_(is_virtual ? 0.0 : thread_cpu_seconds()) {}
  // Adds seconds to a virtual stopwatch. A real one ignores the call.
  void charge(double seconds) { charged_s_ += seconds; }
  // Seconds since the start.
  double seconds() const { return is_virtual_ ? charged_s_ : thread_cpu_seconds() - start_s_; }

 private:
  bool is_virtual_;
  double start_s_, charged_s_ = 0;
};

}  // namespace psygen::core
