#include "engine/core/headroom.hpp"

#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <string>

#include "engine/core/out_of_memory.hpp"

#ifdef __linux__
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace psygen::core {
namespace {

bool can_map(std::uint64_t bytes, int protection) {
  void* memory = mmap(nullptr, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    record_failed_allocation(bytes);
    return false;
  }
  munmap(memory, bytes);
  return true;
}

std::mutex& stacks_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::size_t default_stack_bytes() {
  pthread_attr_t attributes;
  std::size_t bytes = 0;
  if (pthread_getattr_default_np(&attributes) != 0) return 0;
  pthread_attr_getstacksize(&attributes, &bytes);
  pthread_attr_destroy(&attributes);
  return bytes;
}

void set_default_stack_bytes(std::size_t bytes) {
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  pthread_attr_setstacksize(&attributes, bytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

}  // namespace

UsualStacks::UsualStacks() {
  stacks_mutex().lock();
  const std::size_t bytes = default_stack_bytes();
  if (bytes == 0 || bytes >= kThreadStackBytes) return;
  former_bytes_ = bytes;
  set_default_stack_bytes(kThreadStackBytes);
}

UsualStacks::~UsualStacks() {
  if (former_bytes_ > 0) set_default_stack_bytes(former_bytes_);
  stacks_mutex().unlock();
}

Result<void> widen_stacks() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0) return {};
  if (limit.rlim_cur < kThreadStackBytes && limit.rlim_cur < limit.rlim_max) {
    rlimit wider = limit;
    wider.rlim_cur = std::min<rlim_t>(kThreadStackBytes, limit.rlim_max);
    if (setrlimit(RLIMIT_STACK, &wider) == 0) limit = wider;
  }
  if (default_stack_bytes() < kThreadStackBytes) set_default_stack_bytes(kThreadStackBytes);
  if (limit.rlim_cur >= kMinStackBytes) return {};
  return fail(ErrorCode::kInternal, "ulimit -s allows " + std::to_string(limit.rlim_cur >> 10) +
                                        " KiB of stack; at least " +
                                        std::to_string(kMinStackBytes >> 10) + " KiB are needed");
}

struct SignalStack::Stack {
  std::array<std::byte, std::size_t{64} << 10> bytes;
  stack_t former;
};

SignalStack::SignalStack() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  stack_.reset(new (std::nothrow) Stack);
  if (!stack_) return;
  const stack_t wanted{
      .ss_sp = stack_->bytes.data(), .ss_flags = 0, .ss_size = stack_->bytes.size()};
  if (sigaltstack(&wanted, &stack_->former) != 0) stack_.reset();
#endif
}

SignalStack::~SignalStack() {
  if (stack_) sigaltstack(&stack_->former, nullptr);
}

bool memory_left(std::uint64_t bytes) {
  return can_map(bytes, PROT_READ | PROT_WRITE);
}

bool addresses_left(std::uint64_t bytes) {
  return can_map(bytes, PROT_NONE);
}

void lower_priority_of_this_thread() {
#ifdef __linux__
  // Linux applies the nice value to a single thread if it is named by its thread id.
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 19);
#endif
}

void name_this_thread([[maybe_unused]] const std::string& name) {
#ifdef __linux__
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());
#endif
}

}  // namespace psygen::core
