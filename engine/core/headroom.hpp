// How much more the operating system would give to this process. Each function takes the resource
// and returns it at once. This reveals limits (ulimit -d, -v, -u, container limits on threads,
// memory that must not be overcommitted) before a library that cannot handle them runs into them.
// Limits of memory that the kernel enforces by killing are not seen. The answer holds for the
// moment only. POSIX. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::core {

// Whether `bytes` bytes of memory could be allocated. If not, the next out_of_memory() in this
// thread reports them.
bool memory_left(std::uint64_t bytes);
// Like memory_left, for address space without memory behind it.
bool addresses_left(std::uint64_t bytes);
// How many threads could be started, at most `most`. Takes about 10 microseconds per thread.
std::size_t threads_left(std::size_t most);

}  // namespace psygen::core
