// Resources that the operating system would still give to this process. Each function allocates the
// resource and frees it immediately. This reveals limits (ulimit -d, -v, -u, container limits on
// threads, memory that must not be overcommitted) before a library that cannot handle them reaches
// them. It does not see memory limits that the kernel enforces by killing. An answer holds only for
// the moment. Also starts threads where the system may refuse, and sets their stacks and
// priorities. POSIX. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {

// Returns true if `bytes` bytes of memory can be allocated. If not, the next out_of_memory() in
// this thread reports them.
bool memory_left(std::uint64_t bytes);
// Like memory_left(), for address space without memory behind it.
bool addresses_left(std::uint64_t bytes);
// Returns the number of threads that can be started, at most `most`. Takes about 10 microseconds a
// thread.
std::size_t threads_left(std::size_t most);

// Least stack of start_thread()'s threads, whatever `ulimit -s` says: the usual size on Linux,
// which model types and systems of games may expect. Only pages in use take memory. The engine's
// own types use 0.2 MiB of it.
inline constexpr std::size_t kThreadStackBytes = std::size_t{8} << 20;

// While it lives, new threads of this process have at least kThreadStackBytes of stack. std::thread
// knows no sizes, so this is the process's default; one object at a time, others wait.
class UsualStacks {
 public:
  UsualStacks();
  ~UsualStacks();
  UsualStacks(const UsualStacks&) = delete;
  UsualStacks& operator=(const UsualStacks&) = delete;

 private:
  std::size_t former_bytes_ = 0;  // 0: the default is large enough
};

// Least stack of a thread that calls the engine (docs/package.md).
inline constexpr std::size_t kMinStackBytes = std::size_t{256} << 10;

// Gives the main thread, and all threads that the process starts from now on, kThreadStackBytes
// where `ulimit -s` allows less and its hard limit permits more. Fails with kInternal if the main
// thread is left with less than kMinStackBytes. Call it before other threads start.
Result<void> widen_stacks();

// While it lives, handlers of signals that ask for it (SA_ONSTACK) run on a stack of their own in
// this thread, so a handler can report that the thread's stack has overflowed. Without memory for
// it, and in builds with sanitizers, which have their own, it does nothing; on Windows neither.
class SignalStack {
 public:
  SignalStack();
  ~SignalStack();
  SignalStack(const SignalStack&) = delete;
  SignalStack& operator=(const SignalStack&) = delete;

 private:
  struct Stack;
  std::unique_ptr<Stack> stack_;
};

// Runs `work` on a new thread, which the caller joins. Fails with kInternal if the system grants
// this process no thread (ulimit -u, container limits) or no memory for its stack.
template <class Work>
Result<std::thread> start_thread(Work&& work) {
  try {
    const UsualStacks stacks;
    return std::thread([work = std::decay_t<Work>(std::forward<Work>(work))]() mutable {
      const SignalStack stack;
      work();
    });
  } catch (const std::exception& e) {  // std::system_error or std::bad_alloc
    return fail(
        ErrorCode::kInternal,
        std::string("the system gives no more threads, or no memory for one (") + e.what() + ")");
  }
}

// Runs `work` on this thread and on `threads` - 1 further ones, or as many as the system grants,
// and waits for all of them. `work` throws nothing.
template <class Work>
void run_in_threads(std::size_t threads, const Work& work) {
  std::vector<std::thread> helpers;
  helpers.reserve(threads);  // nothing throws while they run
  for (std::size_t i = 1; i < threads; ++i) {
    auto helper = start_thread(std::cref(work));
    if (!helper) break;
    helpers.push_back(std::move(*helper));
  }
  work();
  for (std::thread& helper : helpers)
    helper.join();
}

// Sets nice 19 for the calling thread alone (Linux): it uses processor time that no other thread
// needs. Does nothing on systems without per-thread priorities.
void lower_priority_of_this_thread();
// Sets the name of the calling thread; at most 15 characters are kept.
void name_this_thread(const std::string& name);

}  // namespace psygen::core
