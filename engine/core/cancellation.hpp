// Cancellation of long work. A caller binds a flag to the thread that works for it; loops deep
// inside the work, and libraries that know nothing of the caller, ask for it between pieces of some
// ten milliseconds. Work that starts threads of its own binds the flag in each of them. Not for
// loops of a frame, which have their own conditions. Any thread.
#pragma once

#include <atomic>

#include "engine/core/error.hpp"

namespace psygen::core {

// While it lives, the work of this thread ends early once the flag is true. Nests: the flag of the
// inner scope replaces that of the outer one, and an inner null leaves it as it is.
class CancelScope {
 public:
  // `flag` outlives the scope; any thread may set it. Null: nobody cancels.
  explicit CancelScope(const std::atomic<bool>* flag);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

// The flag of the calling thread's scope, for the threads that its work starts; null: there is
// none.
const std::atomic<bool>* cancel_flag();

// True if the work of the calling thread should end. Some nanoseconds.
bool is_cancelled();

// Fails with kInterrupted if is_cancelled().
Result<void> check_cancelled();

}  // namespace psygen::core
