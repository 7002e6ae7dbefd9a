// Resources that the operating system would still give to this process. Each function allocates the
// resource and frees it immediately. This reveals limits (ulimit -d, -v, -u, container limits on
// threads, memory that must not be overcommitted) before a library that cannot handle them reaches
// them. It does not see memory limits that the kernel enforces by killing. An answer holds only for
// the moment. POSIX. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::core {

// Returns true if `bytes` bytes of memory can be allocated. If not, the next out_of_memory() in
// this thread reports them.
bool memory_left(std::uint64_t bytes);
// Like memory_left(), for address space without memory behind it.
bool addresses_left(std::uint64_t bytes);
// Returns the number of threads that can be started, at most `most`. Takes about 10 microseconds a
// thread.
std::size_t threads_left(std::size_t most);

}  // namespace psygen::core
