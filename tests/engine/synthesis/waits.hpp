// Counts, per thread, the calls by which a thread can wait for another one: locks of all kinds,
// condition variables, semaphores, futexes (used by std::atomic to wait and notify) and yielding
// the processor. The whole test program replaces these functions of the C library with ones that
// count and then call them (waits.cpp), so every lock is counted, whatever code takes it.
#pragma once

#include <cstdint>

namespace psygen::synthesis::testing {

std::uint64_t waits_of_this_thread();

}  // namespace psygen::synthesis::testing
