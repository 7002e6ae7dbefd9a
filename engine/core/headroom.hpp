// What the operating system would still give to this process, found out by taking it and giving it
// back at once: limits (ulimit -d, -v, -u, of containers on threads, of memory that must not be
// overcommitted) then show before a library meets them that cannot bear them. Not seen: limits of
// memory at which the kernel kills. The answer is of the moment. POSIX. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace psygen::core {

// Whether so many bytes of memory could be had. If not, out_of_memory() names them.
bool memory_left(std::uint64_t bytes);
// Whether so many bytes of addresses could be had, without memory behind them. If not, as above.
bool addresses_left(std::uint64_t bytes);
// How many threads could be started, of `most`. Takes some 10 microseconds for each.
std::size_t threads_left(std::size_t most);

}  // namespace psygen::core
