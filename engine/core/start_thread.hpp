// Starts a thread; returns an error where std::thread throws. Not a pool. Any thread.
#pragma once

#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "engine/core/error.hpp"

namespace psygen::core {

// Runs `work` on a new thread, which the caller joins. Fails with kInternal if the system grants
// this process no thread (ulimit -u, container limits) or no memory for its stack.
template <class Work>
Result<std::thread> start_thread(Work&& work) {
  try {
    return std::thread(std::forward<Work>(work));
  } catch (const std::exception& e) {  // std::system_error or std::bad_alloc
    return fail(
        ErrorCode::kInternal,
        std::string("the system gives no more threads, or no memory for one (") + e.what() + ")");
  }
}

}  // namespace psygen::core
