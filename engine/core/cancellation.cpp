#include "engine/core/cancellation.hpp"

#include <utility>

namespace psygen::core {
namespace {

constinit thread_local const std::atomic<bool>* flag_of_thread = nullptr;
constinit thread_local const ShowProgress* progress_of_thread = nullptr;

}  // namespace

CancelScope::CancelScope(const std::atomic<bool>* flag) : before_(flag_of_thread) {
  if (flag != nullptr) flag_of_thread = flag;
}

CancelScope::~CancelScope() {
  flag_of_thread = before_;
}

const std::atomic<bool>* cancel_flag() {
  return flag_of_thread;
}

bool is_cancelled() {
  return flag_of_thread != nullptr && flag_of_thread->load(std::memory_order_relaxed);
}

Result<void> check_cancelled() {
  if (!is_cancelled()) return {};
  return fail(ErrorCode::kInterrupted, "interrupted");
}

ProgressScope::ProgressScope(ShowProgress show)
    : show_(std::move(show)), before_(progress_of_thread) {
  progress_of_thread = &show_;
}

ProgressScope::~ProgressScope() {
  progress_of_thread = before_;
}

void report_progress(double fraction) {
  if (progress_of_thread == nullptr || !*progress_of_thread) return;
  try {
    (*progress_of_thread)(fraction);
  } catch (...) {  // the work goes on without its display
  }
}

}  // namespace psygen::core
