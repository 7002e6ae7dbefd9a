// Work in another thread, with its result as a future. The caller keeps all that the work uses
// alive until the future is ready; the other thread destroys the work itself some time later.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>

#include "engine/core/headroom.hpp"

namespace psygen::core {

// Priority of a thread: the usual one, or the lowest, which takes the time that others leave.
enum class TaskPriority : std::uint8_t { kUsual, kLowest };

// Starts `work` in a new thread. If the system grants none, does it in this one and returns late.
template <class Work>
std::future<std::invoke_result_t<Work&>> start_task(Work&& work,
                                                    TaskPriority priority = TaskPriority::kUsual) {
  using Task = std::packaged_task<std::invoke_result_t<Work&>()>;
  const auto task = std::make_shared<Task>(std::forward<Work>(work));
  auto result = task->get_future();
  auto thread = start_thread([task, priority] {
    if (priority == TaskPriority::kLowest) lower_priority_of_this_thread();
    (*task)();
  });
  if (thread) {
    thread->detach();
  } else {
    (*task)();
  }
  return result;
}

// True if there is a result to take.
template <class Result>
bool is_ready(const std::future<Result>& result) {
  return result.valid() && result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace psygen::core
