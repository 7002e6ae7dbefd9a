// How long a thread sleeps between two looks at whether a message has come: a part of how long none
// has come, so that a message is late by a small part of its time, and who waits for long hardly
// uses a processor. MPI knows no sleep that a message ends. One thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace psygen::cluster {

class Nap {
 public:
  explicit Nap(std::chrono::nanoseconds longest = std::chrono::microseconds(200))
      : longest_(longest) {}
  // Something has come, or will soon.
  void wake() { since_ = Clock::now(); }
  // An eighth of the time since then.
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
