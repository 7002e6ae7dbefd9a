// Polling backoff: sleeps one eighth of the idle time, because MPI has no blocking wait with
// wake-up. A message is therefore late by a small fraction of its waiting time, and a long wait
// uses little processor time. One thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace psygen::cluster {

class Nap {
 public:
  explicit Nap(std::chrono::nanoseconds longest = std::chrono::microseconds(200))
      : longest_(longest) {}
  // Resets the backoff: a message has arrived or will arrive soon.
  void wake() { since_ = Clock::now(); }
  // Returns the next pause: an eighth of the time since wake(), up to the maximum.
  std::chrono::nanoseconds length() const {
    return std::min(longest_, std::chrono::nanoseconds(Clock::now() - since_) / 8);
  }
  void sleep() const { std::this_thread::sleep_for(length()); }

 private:
  using Clock = std::chrono::steady_clock;
  std::chrono::nanoseconds longest_;
  Clock::time_point since_ = Clock::now();
};

}  // namespace psygen::cluster
