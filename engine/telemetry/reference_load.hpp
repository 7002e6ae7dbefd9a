// A fixed load of about two thirds of a second, measured before and after a run: it tells how fast
// the machine was at that time. Three parts: arithmetic on one thread, copies of memory, and the
// same arithmetic on all usable processors at once. Only the last one notices another program that
// uses a processor. Not a benchmark of machines. Any thread, but nothing else of the program should
// run.
#pragma once

#include <cstdint>

#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {

// Wall time and processor time of one part, in seconds. The processor time of `pair` is the sum of
// its threads'.
struct LoadTimes {
  Figure wall_s, cpu_s;
};
struct ReferenceLoad {
  LoadTimes arith, stream, pair;
};

// Amount of work. Other amounts than these are for tests: times are comparable only for one amount.
struct ReferenceWork {
  // Steps of `arith`, and of each thread of `pair`. A step: x <- 6364136223846793005 x +
  // 1442695040888963407 (Knuth's MMIX), three xor-shifts of a second word (13, 7, 17; Marsaglia
  // 2003), and two floating multiply-adds, each of which needs the one before.
  std::uint64_t steps = 100'000'000;
  std::uint64_t copy_bytes = 32ull << 20;  // copied there and back
  int copies = 40;
  std::uint64_t threads = 0;  // of `pair`; 0: the processors that the process may use
};

// Runs the load. A part is missing, with the reason, if the system has no memory or threads for it.
ReferenceLoad measure_reference_load(const ReferenceWork& work = {});

// Mean of the measurements before and after a run. A part is missing if it is in one of them.
ReferenceLoad mean_of(const ReferenceLoad& before, const ReferenceLoad& after);

// Processor time of all three parts, in seconds.
Figure cpu_seconds_of(const ReferenceLoad& load);

}  // namespace psygen::telemetry
