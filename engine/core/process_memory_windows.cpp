#include "engine/core/process_memory.hpp"

#define PSAPI_VERSION 2  // in the library that every program has
#include <windows.h>
// After windows.h.
#include <psapi.h>

namespace psygen::core {

unsigned long memory_in_use_mib() {
  PROCESS_MEMORY_COUNTERS counters{};
  if (GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters) == 0) return 0;
  return static_cast<unsigned long>(counters.PagefileUsage >> 20);
}

std::array<MemoryLimit, 2> memory_limits() {
  return {};
}

}  // namespace psygen::core
