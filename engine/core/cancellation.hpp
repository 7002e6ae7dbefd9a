// Cancellation and progress of long work. A caller binds a cancel flag and a progress callback to
// its thread. Long loops, which know nothing of the caller, check the flag and report progress
// about every 10 ms. Work that starts threads binds the flag in each of them; only the caller's
// thread reports. Not for loops of a frame, which have their own conditions. Any thread.
#pragma once

#include <atomic>
#include <functional>

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

// Shows the fraction of the work that is done, 0 … 1. Its exceptions are ignored.
using ShowProgress = std::function<void(double fraction)>;

// While it lives, report_progress() of this thread calls a function; an empty one is not called.
// Nests: the inner scope replaces the outer one.
class ProgressScope {
 public:
  explicit ProgressScope(ShowProgress show);
  ~ProgressScope();
  ProgressScope(const ProgressScope&) = delete;
  ProgressScope& operator=(const ProgressScope&) = delete;

 private:
  ShowProgress show_;
  const ShowProgress* before_;
};

// Calls the function of the calling thread's scope, if there is one. Throws nothing.
void report_progress(double fraction);

}  // namespace psygen::core
