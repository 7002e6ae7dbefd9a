// What is said where memory ends: for what it was, how much more was wanted, how much there is and
// what limits it. Nothing here takes memory but the std::string. Any thread.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// An allocation of so many bytes has failed in this thread; 0 forgets it. For whoever makes it, and
// for the operator new of a program.
void note_refused_bytes(std::size_t bytes);

// "<what>: memory ran out (N bytes more were wanted; M MiB are in use, ulimit -d allows L MiB)". N
// is what was noted last in this thread, in MiB from 10 of them on, and is left out where nothing
// was noted; so is an empty `what`. Forgets what was noted.
std::string out_of_memory(std::string_view what);
// The same into `buffer`, cut to its size, for where a string cannot be made.
std::string_view out_of_memory(std::string_view what, std::span<char> buffer);

// What f(), which returns a Result<void>, returns; kOutOfMemory where it throws std::bad_alloc.
template <class F>
Result<void> within_memory(std::string_view what, const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, out_of_memory(what));
  }
}

}  // namespace psygen::core
