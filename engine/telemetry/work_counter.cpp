#include "engine/telemetry/work_counter.hpp"

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>

#include "engine/core/clock.hpp"

namespace psygen::telemetry {
namespace {

// The instruction counter of the thread that creates it.
class InstructionCounter {
 public:
  InstructionCounter() {
    perf_event_attr attributes{};
    attributes.size = sizeof attributes;
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    constexpr int kThisThread = 0, kAnyProcessor = -1, kNoGroup = -1;
    file_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, kThisThread, kAnyProcessor,
                                     kNoGroup, PERF_FLAG_FD_CLOEXEC));
  }
  ~InstructionCounter() {
    if (file_ >= 0) close(file_);
  }
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  bool works() const { return file_ >= 0; }
  std::uint64_t read() const {
    std::uint64_t count = 0;
    return ::read(file_, &count, sizeof count) == sizeof count ? count : 0;
  }

 private:
  int file_ = -1;
};

}  // namespace

std::string_view name_of(WorkUnit unit) {
  return unit == WorkUnit::kInstructions ? "instructions" : "processor time";
}

WorkUnit work_unit() {
  static const WorkUnit unit =
      InstructionCounter().works() ? WorkUnit::kInstructions : WorkUnit::kProcessorTime;
  return unit;
}

std::uint64_t work_of_thread() {
  if (work_unit() == WorkUnit::kProcessorTime)
    return static_cast<std::uint64_t>(std::llround(core::thread_cpu_seconds() * 1e9));
  static const thread_local InstructionCounter counter;
  return counter.works() ? counter.read() : 0;
}

}  // namespace psygen::telemetry
