// The message for exhausted memory: what it was for, how much more was requested, how much is in
// use and what limits it. Not an allocator. Allocates nothing except the std::string. Any thread.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// Notes that an allocation of `bytes` bytes has failed in this thread; 0 forgets it. Called by the
// code that allocates and by a program's operator new.
void note_refused_bytes(std::size_t bytes);

// "<what>: memory ran out (N bytes more were wanted; M MiB are in use, ulimit -d allows L MiB)". N
// is the size last noted in this thread, in MiB from 10 MiB on; it is left out when none was noted,
// and so is an empty `what`. Forgets what was noted. At most 511 bytes.
std::string out_of_memory(std::string_view what);
// The same written into `buffer` (not empty) and cut to its size, for when no string can be made.
std::string_view out_of_memory(std::string_view what, std::span<char> buffer);

// Returns f()'s Result<void>, or kOutOfMemory when f() throws std::bad_alloc.
template <class F>
Result<void> within_memory(std::string_view what, const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, out_of_memory(what));
  }
}

}  // namespace psygen::core
