// The message for exhausted memory: the purpose, the bytes requested, the bytes in use and the
// limit. Not an allocator. Allocates nothing except the std::string. Any thread.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// Records that an allocation of `bytes` bytes has failed in this thread; 0 clears the record. Code
// that allocates calls it, and so does a program's operator new.
void record_failed_allocation(std::size_t bytes);

// Returns "<what>: memory ran out (N bytes more were wanted; M MiB are in use, ulimit -d allows
// L MiB)". N is the size last recorded in this thread, in MiB from 10 MiB on. The message omits N
// without a record, and an empty `what`. Clears the record. At most 511 bytes.
std::string out_of_memory(std::string_view what);
// Writes the same message into `buffer` (not empty) and cuts it to that size, for callers that
// cannot allocate a string.
std::string_view out_of_memory(std::string_view what, std::span<char> buffer);

// Returns f()'s Result<void>, or kOutOfMemory if f() throws std::bad_alloc.
template <class F>
Result<void> catch_out_of_memory(std::string_view what, const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, out_of_memory(what));
  }
}

// The error for the exception that is being handled: kOutOfMemory with out_of_memory(subject) for
// std::bad_alloc, else `code` with "<subject> <verb>: <message of the exception>".
Error error_of_exception(ErrorCode code, std::string_view subject, std::string_view verb);

// Calls code that may throw anything, such as that of users. Returns its Result<void>, or
// error_of_exception(). `subject` returns a text, which only an exception needs.
template <class Subject, class F>
Result<void> catch_exceptions(ErrorCode code, const Subject& subject, std::string_view verb,
                              const F& f) {
  try {
    return f();
  } catch (...) {
    return tl::unexpected(error_of_exception(code, subject(), verb));
  }
}

}  // namespace psygen::core
