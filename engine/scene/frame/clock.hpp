// The times of a tick, and the state of the fixed-step simulation. Values.
#pragma once

#include <cstdint>
#include <functional>

namespace psygen::scene {

struct Clock {
  double now_s = 0;   // of the flight: real, or frame / rate with a fixed step
  double real_s = 0;  // real seconds since the scene was created, for latencies; set by each tick
  std::function<double()> read_real_s;  // source of real_s; returns now_s in virtual time
  std::uint32_t tick = 1;
};

// The simulation's state. Systems of frames and of steps read it.
struct FixedStep {
  double step_s = 1.0 / 60.0;  // > 0
  std::uint64_t index = 0;     // steps that have begun; the first one sees 1
  // Fraction of a step by which the frame is ahead of the last step: 0 … 1. Draw moving entities
  // between their states before and after the last step, at this fraction.
  double share = 0;
  // Simulated seconds at the end of the last step that has begun.
  double now_s() const { return static_cast<double>(index) * step_s; }
};

}  // namespace psygen::scene
