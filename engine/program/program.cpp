#include "engine/program/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/program/crash_report.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/resource.h>
#endif

namespace psygen::program {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);
std::terminate_handler terminate_before = nullptr;
std::array<char, 64> program_name{};  // cut to fit

// Reserves the descriptors of closed streams (`>&-`), so that a file opened later does not receive
// their output. Writing to such a stdout fails, as it should.
void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is this stream's.
    (void)open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// Makes the C library keep freed memory instead of returning it to the kernel page by page:
// software rasterisers allocate and free their bins every frame. Does nothing if the process's
// memory is limited (ulimit -d, ulimit -v), or if the C library is not glibc.
void keep_freed_memory() {
#ifdef __GLIBC__
  for (const auto resource : {RLIMIT_DATA, RLIMIT_AS}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  }
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_TOP_PAD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
#endif
}

// Reports an error without allocating.
void say(std::string_view sentence) {
  std::array<char, 640> line;
  const int length =
      std::snprintf(line.data(), line.size(), "%s: error: %.*s\n", program_name.data(),
                    static_cast<int>(sentence.size()), sentence.data());
  const auto bytes = std::min(static_cast<std::size_t>(length), line.size() - 1);
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), bytes);
}

// Reports the exception that is being handled if it tells of a lack of memory or threads. Returns
// false for others, whose message is kept for the report of a crash.
bool say_want() {
  std::array<char, 512> buffer;
  try {
    throw;
  } catch (const std::bad_alloc&) {
    say(core::out_of_memory("", buffer));
  } catch (const std::system_error& error) {
    say(error.what());
  } catch (const std::exception& error) {
    note_cause_of_crash(error.what());
    return false;
  } catch (...) {
    return false;
  }
  return true;
}

// For exceptions that end in std::terminate, from threads and libraries.
void install_terminate_handler() {
  terminate_before = std::set_terminate([] {
    if (std::current_exception() != nullptr && say_want()) std::_Exit(kFailed);
    terminate_before();
  });
}

void handle(int signal_number, int flags) {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = true; };
  action.sa_flags = SA_RESTART | flags;
  sigaction(signal_number, &action, nullptr);
}

bool is_ignored(int signal_number) {
  struct sigaction action {};
  return sigaction(signal_number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

int run(std::string_view name, const std::function<int()>& body) {
  reserve_standard_streams();
  keep_freed_memory();  // before the first large allocation
  name.copy(program_name.data(), program_name.size() - 1);
  core::set_log_name(name);
  install_terminate_handler();
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  if (const auto stacks = core::widen_stacks(); !stacks) return fail_with(stacks.error());
  // psygen throws nothing, but libraries do when memory runs out.
  try {
    report_crashes(name);
    return body();
  } catch (const std::exception& error) {
    if (!say_want()) say(error.what());
  } catch (...) {
    say("an exception that is not a std::exception");
  }
  return kFailed;
}

int run(std::string_view name, const std::function<core::Result<void>()>& body) {
  return run(name, [&] { return exit_code(body()); });
}

int exit_code_of(const core::Error& error) {
  return error.code == core::ErrorCode::kNoDevice ? kNoDevice : kFailed;
}

int exit_code(const core::Result<void>& result) {
  if (result || result.error().code == core::ErrorCode::kInterrupted) return kOk;
  return fail_with(result.error());
}

int fail_with(const core::Error& error) {
  core::log_error(error.message);
  return exit_code_of(error);
}

const std::atomic<bool>& stop_at_interrupt() {
  constexpr auto kOnce = static_cast<int>(SA_RESETHAND);
  // Users who press Ctrl+C twice do not want to wait. A closed terminal sends SIGHUP twice, from
  // the kernel and from the shell; under nohup it is ignored.
  handle(SIGINT, kOnce);
  handle(SIGTERM, kOnce);
  if (!is_ignored(SIGHUP)) handle(SIGHUP, 0);
  return interrupted;
}

int print(const std::string& text) {
  errno = 0;
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kOk;
  if (errno != EPIPE)
    core::log_error(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
  return kFailed;
}

}  // namespace psygen::program

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
