#include "engine/core/headroom.hpp"

#include <sys/mman.h>

#include <exception>
#include <latch>
#include <thread>
#include <vector>

#include "engine/core/out_of_memory.hpp"

#ifdef __linux__
#include <pthread.h>
#include <sys/resource.h>
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

}  // namespace

bool memory_left(std::uint64_t bytes) {
  return can_map(bytes, PROT_READ | PROT_WRITE);
}

bool addresses_left(std::uint64_t bytes) {
  return can_map(bytes, PROT_NONE);
}

std::size_t threads_left(std::size_t most) {
  std::vector<std::thread> threads;
  std::latch counted(1);
  try {
    threads.reserve(most);
    while (threads.size() < most)
      threads.emplace_back([&counted] { counted.wait(); });
  } catch (const std::exception&) {  // no more threads, or no memory for one
  }
  counted.count_down();
  for (std::thread& thread : threads)
    thread.join();
  return threads.size();
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
