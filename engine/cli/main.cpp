// psygen: the command line. commands.cpp lists the subcommands; this file selects one. Data goes to
// stdout, messages and progress to stderr. Exit codes: 0 success, 1 failure, 2 usage error, 3
// missed budget or regression in B, 4 no usable GPU or display (77 from psygen test).

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>

#include "engine/cli/commands.hpp"
#include "engine/cli/usage.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/render/device/software_tuning.hpp"

namespace psygen::cli {
namespace {

// Reserves the descriptors of closed streams (`>&-`), so that a file opened later does not receive
// their output. Writing to such a stdout fails, as it should.
void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is this stream's.
    (void)open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// A pipe without a reader (SIGPIPE) and a file beyond `ulimit -f` (SIGXFSZ) fail the write instead
// of ending the program.
void ignore_write_signals() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

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

// Handles exceptions that end in std::terminate, from threads and libraries. Others still abort.
void install_terminate_handler() {
  terminate_before = std::set_terminate([] {
    if (std::current_exception() != nullptr && say_want()) std::_Exit(kFailed);
    terminate_before();
  });
}

// Reports the exception that is being handled, without allocating. Returns kFailed.
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

}  // namespace
}  // namespace psygen::cli

// Records the size of a failed allocation. Sanitizers provide their own operator new, which detects
// more errors.
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

int main(int argc, char** argv) {
  psygen::cli::reserve_standard_streams();
  psygen::render::tune_allocator_for_software_rendering();  // before the first large allocation
  psygen::cli::install_terminate_handler();
  psygen::cli::ignore_write_signals();

  CLI::App cli("psygen: fly through procedural worlds larger than memory", "psygen");
  cli.set_version_flag("--version", "psygen " + std::string(psygen::core::version()));
  cli.require_subcommand(1);
  const auto commands = psygen::cli::make_commands(cli);
  // After the commands, which would otherwise inherit the footer.
  cli.footer(
      "Example:\n"
      "  psygen fly --headless --world silver_combe --path combe --out out\n"
      "psygen COMMAND --help lists the options of a command.");
  if (const auto code = psygen::cli::read_command_line(cli, argc, argv)) return *code;
  // psygen throws nothing, but libraries do when memory runs out.
  try {
    for (const auto& command : commands)
      if (command->chosen()) return command->run();
  } catch (...) {
    return psygen::cli::report_current_exception();
  }
  return psygen::cli::kUsage;
}
