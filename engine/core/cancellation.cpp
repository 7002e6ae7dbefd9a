#include "engine/core/cancellation.hpp"

namespace psygen::core {
namespace {

constinit thread_local const std::atomic<bool>* flag_of_thread = nullptr;

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

}  // namespace psygen::core
