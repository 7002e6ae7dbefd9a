#include "engine/core/headroom.hpp"

#include <pthread.h>
#include <windows.h>

#include "engine/core/out_of_memory.hpp"

namespace psygen::core {
namespace {

bool can_reserve(std::uint64_t bytes, DWORD kind) {
  void* memory = VirtualAlloc(nullptr, bytes, kind, PAGE_READWRITE);
  if (memory == nullptr) {
    record_failed_allocation(bytes);
    return false;
  }
  VirtualFree(memory, 0, MEM_RELEASE);
  return true;
}

}  // namespace

// Windows has no limit of a process for stacks. The linker sets their size, for all threads.
UsualStacks::UsualStacks() = default;
UsualStacks::~UsualStacks() = default;
Result<void> widen_stacks() {
  return {};
}

struct SignalStack::Stack {};
SignalStack::SignalStack() = default;
SignalStack::~SignalStack() = default;

bool memory_left(std::uint64_t bytes) {
  return can_reserve(bytes, MEM_RESERVE | MEM_COMMIT);
}

bool addresses_left(std::uint64_t bytes) {
  return can_reserve(bytes, MEM_RESERVE);
}

void lower_priority_of_this_thread() {
  SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_IDLE);
}

void name_this_thread(const std::string& name) {
  pthread_setname_np(pthread_self(), name.substr(0, 15).c_str());  // MinGW-w64's threads
}

}  // namespace psygen::core
