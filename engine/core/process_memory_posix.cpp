#include "engine/core/process_memory.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>

namespace psygen::core {
namespace {

constexpr unsigned long kMiB = 1ul << 20;

MemoryLimit limit_of(decltype(RLIMIT_DATA) resource, const char* name) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  return {name, static_cast<unsigned long>(limit.rlim_cur) / kMiB};
}

}  // namespace

unsigned long memory_in_use_mib() {
  std::array<char, 256> text{};
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  unsigned long data_pages = 0;
  if (size <= 0 || std::sscanf(text.data(), "%*u %*u %*u %*u %*u %lu", &data_pages) != 1) return 0;
  return data_pages * static_cast<unsigned long>(sysconf(_SC_PAGESIZE)) / kMiB;
}

std::array<MemoryLimit, 2> memory_limits() {
  return {limit_of(RLIMIT_DATA, "ulimit -d"), limit_of(RLIMIT_AS, "ulimit -v")};
}

}  // namespace psygen::core
