#include "engine/cli/fatal.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "engine/cli/commands.hpp"
#include "engine/core/out_of_memory.hpp"

namespace psygen::cli {
namespace {

std::terminate_handler terminate_before = nullptr;

void say(std::string_view sentence) {
  std::array<char, 640> line;
  const int length = std::snprintf(line.data(), line.size(), "psygen: error: %.*s\n",
                                   static_cast<int>(sentence.size()), sentence.data());
  const auto bytes = std::min(static_cast<std::size_t>(length), line.size() - 1);
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), bytes);
}

// Returns false unless the exception reports a lack of memory or threads.
bool say_want() {
  std::array<char, 512> buffer;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    say(core::out_of_memory("", buffer));
  } catch (const std::system_error& error) {
    say(error.what());
  } catch (...) {
    return false;
  }
  return true;
}

}  // namespace

void install_terminate_handler() {
  terminate_before = std::set_terminate([] {
    if (std::current_exception() != nullptr && say_want()) std::_Exit(kFailed);
    terminate_before();
  });
}

int report_current_exception() {
  if (say_want()) return kFailed;
  try {
    throw;
  } catch (const std::exception& error) {
    say(error.what());
  } catch (...) {
    say("an exception that is not a std::exception");
  }
  return kFailed;
}

}  // namespace psygen::cli

// Sanitizers provide their own operator new, which detects more errors.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

void* noted(void* memory, std::size_t bytes) {
  if (memory != nullptr) return memory;
  psygen::core::record_failed_allocation(bytes);
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t bytes) {
  return noted(std::malloc(bytes > 0 ? bytes : 1), bytes);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return noted(std::aligned_alloc(step, (bytes + step - 1) / step * step), bytes);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#endif
