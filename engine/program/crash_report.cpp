#include "engine/program/crash_report.hpp"

#include <execinfo.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "engine/core/data_file.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/core/utf8.hpp"
#include "engine/telemetry/machine.hpp"

namespace psygen::program {
namespace {

constexpr std::pair<int, std::string_view> kSignals[] = {{SIGSEGV, "SIGSEGV"},
                                                         {SIGBUS, "SIGBUS"},
                                                         {SIGFPE, "SIGFPE"},
                                                         {SIGILL, "SIGILL"},
                                                         {SIGABRT, "SIGABRT"}};
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
constexpr std::size_t kMaxFrames = 100, kMaxCommandBytes = 1000;

// A text in fixed memory, which a crash can read whatever has happened to the heap.
template <std::size_t kBytes>
class FixedText {
 public:
  void set(std::string_view text) { size_ = text.copy(text_.data(), kBytes - 1); }
  std::string_view view() const { return {text_.data(), size_}; }
  char* data() { return text_.data(); }  // ends in a 0

 private:
  std::array<char, kBytes> text_{};
  std::size_t size_ = 0;
};

FixedText<64> name;                                  // of the program
FixedText<4096> heading;                             // of the report
FixedText<PATH_MAX> state_folder, temporary_folder;  // empty: none
FixedText<400> cause;                                // of note_cause_of_crash()
std::array<void*, kMaxFrames> frames;
std::atomic<pid_t> reporting_thread{0};
static_assert(std::atomic<pid_t>::is_always_lock_free);

// Writes lines to a descriptor. {fmt} formats numbers and texts without memory or locks.
class Lines {
 public:
  explicit Lines(int descriptor) : descriptor_(descriptor) {}

  template <class... T>
  void add(fmt::format_string<const T&...> format, const T&... values) {
    std::array<char, 5000> text;
    const auto end = fmt::format_to_n(text.data(), text.size() - 1, format, values...);
    *end.out = '\n';
    const auto bytes = static_cast<std::size_t>(end.out - text.data()) + 1;
    whole_ = whole_ && write(descriptor_, text.data(), bytes) == static_cast<ssize_t>(bytes);
  }
  void add_stack() {
    const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
    backtrace_symbols_fd(frames.data(), count, descriptor_);
  }
  void add_log() { whole_ = core::write_kept_log_lines(descriptor_) && whole_; }
  bool whole() const { return whole_; }  // everything could be written

 private:
  int descriptor_;
  bool whole_ = true;
};

std::string_view name_of(int signal_number) {
  const auto* const found =
      std::ranges::find(kSignals, signal_number, &std::pair<int, std::string_view>::first);
  return found->second;
}

// Date and time of the UTC, "20261129T025011Z".
std::string_view time_of_crash(std::array<char, 32>& text) {
  using namespace std::chrono;
  const auto now = time_point_cast<seconds>(system_clock::now());
  const auto day = floor<days>(now);
  const year_month_day date(day);
  const hh_mm_ss time(now - day);
  const auto end = fmt::format_to_n(
      text.data(), text.size(), "{:04}{:02}{:02}T{:02}{:02}{:02}Z", static_cast<int>(date.year()),
      static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), time.hours().count(),
      time.minutes().count(), time.seconds().count());
  return {text.data(), end.out};
}

bool write_report(int descriptor, int signal_number, const siginfo_t& info) {
  Lines report(descriptor);
  std::array<char, 32> time{};
  std::array<char, 17> thread{};
  prctl(PR_GET_NAME, thread.data());
  report.add("{}", heading.view());
  report.add("time: {}", time_of_crash(time));
  report.add("signal: {}", name_of(signal_number));
  if (info.si_code > 0)  // by the processor, not by a function or another process
    report.add("address: {:#x}", reinterpret_cast<std::uintptr_t>(info.si_addr));
  if (!cause.view().empty()) report.add("cause: {}", cause.view());
  report.add("thread: {}\n\nstack:", std::string_view(thread.data()));
  report.add_stack();
  report.add("\nlast log lines:");
  report.add_log();
  return report.whole();
}

// Creates a folder and those around it.
void make_folders(FixedText<PATH_MAX>& folder) {
  for (char* at = folder.data() + 1; *at != '\0'; ++at) {
    if (*at != '/') continue;
    *at = '\0';
    mkdir(folder.data(), 0700);
    *at = '/';
  }
  mkdir(folder.data(), 0700);
}

// Writes the report to a new file. Returns false, and leaves no file, if that fails.
bool write_file(FixedText<PATH_MAX>& folder, int signal_number, const siginfo_t& info) {
  if (folder.view().empty()) return false;
  make_folders(folder);
  std::array<char, 32> time{};
  std::array<char, PATH_MAX + 128> path{};
  fmt::format_to_n(path.data(), path.size() - 1, "{}/{}-crash-{}-{}.txt", folder.view(),
                   name.view(), time_of_crash(time), getpid());
  const int file = open(path.data(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) return false;
  const bool whole = write_report(file, signal_number, info);
  close(file);
  if (!whole) {
    unlink(path.data());
    return false;
  }
  Lines(STDERR_FILENO)
      .add("{}: error: crashed by {}; the report is {}", name.view(), name_of(signal_number),
           std::string_view(path.data()));
  return true;
}

void report(int signal_number, const siginfo_t& info) {
  if (write_file(state_folder, signal_number, info) ||
      write_file(temporary_folder, signal_number, info))
    return;
  Lines(STDERR_FILENO)
      .add("{}: error: crashed by {}; no folder takes the report:", name.view(),
           name_of(signal_number));
  write_report(STDERR_FILENO, signal_number, info);
}

void on_crash(int signal_number, siginfo_t* info, void*) {
  const auto own = static_cast<pid_t>(syscall(SYS_gettid));
  pid_t before = 0;
  if (reporting_thread.compare_exchange_strong(before, own)) {
    report(signal_number, *info);
  } else if (before != own) {
    for (;;)
      pause();  // until the other thread ends the program
  }
  signal(signal_number, SIG_DFL);
  raise(signal_number);  // blocked until this function returns, so a core dump has the true stack
}

// The command line of this process.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline");
  std::string text;
  std::getline(file, text);
  std::ranges::replace(text, '\0', ' ');
  return core::shown(text, kMaxCommandBytes);
}

std::string text_of(const telemetry::MeasuredText& text) {
  return text.has_value() ? *text : "unknown";
}

std::string text_of_heading() {
  const telemetry::BuildFacts build = telemetry::build_facts();
  const telemetry::MachineFacts machine = telemetry::machine_facts();
  const bool changed = build.clean.has_value() && !*build.clean;
  return fmt::format(
      "Report of a crash. A bug report needs this file and the steps that led here.\n"
      "program: {}, psygen {}, revision {}{}, {}, {}\n"
      "command: {}\n"
      "machine: {}, {} cores, quota {}, {} MiB of memory, kernel {}, governor {}\n"
      "extensions: {}",
      name.view(), build.version, text_of(build.revision), changed ? " with changes" : "",
      build.compiler, build.type, command_line(), text_of(machine.cpu), machine.cores,
      machine.quota_cores.has_value() ? fmt::format("{:g}", *machine.quota_cores) : "none",
      machine.memory_bytes.has_value() ? *machine.memory_bytes >> 20 : 0, text_of(machine.kernel),
      text_of(machine.governor), text_of(machine.cpu_features));
}

}  // namespace

void report_crashes(std::string_view program) {
  if constexpr (kSanitized) return;
  name.set(program);
  heading.set(text_of_heading());
  const auto state = core::user_folder_path(core::UserFolder::kState, std::string(program));
  if (state) state_folder.set(state->native());
  std::error_code error;
  temporary_folder.set(std::filesystem::temp_directory_path(error).native());
  backtrace(frames.data(), 1);  // loads the unwinder, which takes memory
  static const core::SignalStack& stack = *new core::SignalStack();  // of the main thread
  (void)stack;
  for (const auto& [signal_number, signal_name] : kSignals) {
    struct sigaction before {
    }, action{};
    if (sigaction(signal_number, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) continue;
    action.sa_sigaction = on_crash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigfillset(&action.sa_mask);
    sigaction(signal_number, &action, nullptr);
  }
}

void note_cause_of_crash(std::string_view sentence) {
  cause.set(sentence);
}

}  // namespace psygen::program
