// Work in another thread, with its result as a future. The caller waits for the future before what
// the work uses ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>

#include "engine/core/headroom.hpp"

namespace psygen::core {

// Of a task: as other threads, or only processor time that no other thread needs.
enum class TaskPriority : std::uint8_t { kUsual, kLowest };

// Starts `work` in a new thread; if the system grants none, does it at once in this one.
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
