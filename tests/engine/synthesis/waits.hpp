// Counts, for each thread by itself, the calls by which a thread can wait for another one: locks of
// all kinds, condition variables, semaphores, futexes (what std::atomic waits and notifies with)
// and giving up the processor. The functions of the C library are replaced in the whole test
// program by ones that count and go on to them (waits.cpp), so that a lock is counted whoever takes
// it.
#pragma once

#include <cstdint>

namespace psygen::synthesis::testing {

std::uint64_t waits_of_this_thread();

}  // namespace psygen::synthesis::testing
