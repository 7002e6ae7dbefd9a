// Counts the work of the calling thread: its instructions where the processor's counters may be
// read, else its processor time. Unlike wall time, neither includes waits and other programs.
// Linux: perf_event_open(2). Any thread.
#pragma once

#include <cstdint>
#include <string_view>

namespace psygen::telemetry {

enum class WorkUnit : std::uint8_t {
  kInstructions,   // in user space
  kProcessorTime,  // nanoseconds, in user space and in the kernel
};
std::string_view name_of(WorkUnit unit);  // "instructions", "processor time"

// The unit of this process. Virtual machines and kernel.perf_event_paranoid over 2 hide the
// counters.
WorkUnit work_unit();

// The work of the calling thread since an arbitrary start, in work_unit(). A counter that cannot be
// read gives 0. A system call: about 0.3 µs.
std::uint64_t work_of_thread();

}  // namespace psygen::telemetry
