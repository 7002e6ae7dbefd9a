// Starts a thread or says why not, where std::thread throws. Not a pool.
#pragma once

#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "engine/core/error.hpp"

namespace psygen::core {

// Fails with kInternal: the system has no thread for this process (ulimit -u, limits of a
// container) or no memory for its stack.
template <class Work>
Result<std::thread> start_thread(Work&& work) {
  try {
    return std::thread(std::forward<Work>(work));
  } catch (const std::exception& e) {  // std::system_error or std::bad_alloc
    return fail(ErrorCode::kInternal,
                std::string("the system gives no more threads (") + e.what() + ")");
  }
}

}  // namespace psygen::core
