// The memory of this process and its limits, for messages. Allocates nothing. Any thread.
#pragma once

#include <array>

namespace psygen::core {

// Memory of this process without a file behind it, in MiB; 0 if the system does not report it.
unsigned long memory_in_use_mib();

// A limit that the process has: how users set it, in MiB.
struct MemoryLimit {
  const char* name = nullptr;  // null: none
  unsigned long mib = 0;
};
std::array<MemoryLimit, 2> memory_limits();

}  // namespace psygen::core
