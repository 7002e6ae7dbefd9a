#include "engine/core/headroom.hpp"

#include <exception>
#include <latch>
#include <thread>
#include <vector>

namespace psygen::core {

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

}  // namespace psygen::core
