// Time. Seconds as doubles from a monotonic clock; CPU time of the calling thread.
#pragma once

namespace psygen::core {

double monotonic_seconds();
double thread_cpu_seconds();

// What the calling thread has spent since it was made, in seconds: of its processor, so that others
// who take it away do not count, or virtual ones, which are what the stopwatch was charged with.
class Stopwatch {
 public:
  explicit Stopwatch(bool is_virtual = false)
      : is_virtual_(is_virtual), start_s_(is_virtual ? 0.0 : thread_cpu_seconds()) {}
  // What something takes on the virtual clock; a real one knows by itself.
  void charge(double seconds) { charged_s_ += seconds; }
  double seconds() const { return is_virtual_ ? charged_s_ : thread_cpu_seconds() - start_s_; }

 private:
  bool is_virtual_;
  double start_s_, charged_s_ = 0;
};

}  // namespace psygen::core
