#include "tests/faults.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "tests/next_function.hpp"

namespace {

using psygen::next;

// The functions that this file replaces. The start looks all of them up, because dlsym() cannot
// free memory when the thread sanitizer calls open() later.
struct Real {
  decltype(&::open) open = next<decltype(::open)>("open");
  decltype(&::write) write = next<decltype(::write)>("write");
  decltype(&::fsync) fsync = next<decltype(::fsync)>("fsync");
  decltype(&::close) close = next<decltype(::close)>("close");
  decltype(&::rename) rename = next<decltype(::rename)>("rename");
  decltype(&::clock_gettime) clock_gettime = next<decltype(::clock_gettime)>("clock_gettime");
  decltype(&::pthread_create) pthread_create = next<decltype(::pthread_create)>("pthread_create");
};
const Real& real() {
  static const Real functions;
  return functions;
}

constexpr long kUnlimited = LONG_MAX;

char full_folder[PATH_MAX] = "";
std::atomic<long> calls_left{kUnlimited};
std::atomic<long> threads_left{kUnlimited};
std::atomic<const char*> threads_of{"libstdc++"};
std::atomic<double> monotonic_off_s{0}, boot_off_s{0};

// Returns true if this call exceeds the number of calls left.
bool runs_out(std::atomic<long>& left) {
  return left.load() != kUnlimited && left.fetch_sub(1) <= 0;
}

// Returns true if the process dies at the point where the disk would be full.
bool dies = false;

bool is_on_disk(const char* path) {
  return std::strncmp(path, full_folder, std::strlen(full_folder)) == 0;
}

bool is_on_disk(int file) {
  char link[64];
  std::snprintf(link, sizeof(link), "/proc/self/fd/%d", file);
  char path[PATH_MAX] = "";
  return readlink(link, path, sizeof(path) - 1) > 0 && is_on_disk(path);
}

template <class File>
bool disk_refuses(File file) {
  if (calls_left.load() == kUnlimited || !is_on_disk(file) || !runs_out(calls_left)) return false;
  if (dies) kill(getpid(), SIGKILL);
  errno = ENOSPC;
  return true;
}

bool is_concerned(const void* caller) {
  Dl_info info{};
  return dladdr(caller, &info) != 0 && std::strstr(info.dli_fname, threads_of.load()) != nullptr;
}

// Returns true if the caller is in the same library as this function.
bool is_our_own(const void* caller) {
  Dl_info info{}, own{};
  return dladdr(caller, &info) != 0 && dladdr(&monotonic_off_s, &own) != 0 &&
         info.dli_fbase == own.dli_fbase;
}

void fill_disk(const char* folder, long calls) {
  std::snprintf(full_folder, sizeof(full_folder), "%s", folder);
  calls_left = calls;
}

[[maybe_unused]] const bool kStarted = [] {
  real();
  if (const char* folder = std::getenv("PSYGEN_FULL_DISK")) {
    const char* calls = std::getenv("PSYGEN_CALLS_LEFT");
    fill_disk(folder, calls != nullptr ? std::atol(calls) : 0);
  }
  dies = std::getenv("PSYGEN_DIES") != nullptr;
  if (const char* threads = std::getenv("PSYGEN_THREADS_LEFT")) threads_left = std::atol(threads);
  return true;
}();

}  // namespace

namespace psygen {

FullDisk::FullDisk(const std::filesystem::path& folder, std::size_t calls) {
  fill_disk(folder.c_str(), static_cast<long>(calls));
}
FullDisk::~FullDisk() {
  calls_left = kUnlimited;
}
bool FullDisk::was_met() const {
  return calls_left.load() < 0;
}

FewThreads::FewThreads(std::size_t threads, const char* library) {
  threads_of = library;
  threads_left = static_cast<long>(threads);
}
FewThreads::~FewThreads() {
  threads_left = kUnlimited;
}

WrongClock::WrongClock(double monotonic_s, double boot_s) {
  monotonic_off_s = monotonic_s;
  boot_off_s = boot_s;
}
WrongClock::~WrongClock() {
  monotonic_off_s = boot_off_s = 0;
}

}  // namespace psygen

extern "C" {

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0) {
    va_list list;
    va_start(list, flags);
    mode = static_cast<mode_t>(va_arg(list, unsigned));
    va_end(list);
    if (disk_refuses(path)) return -1;
  }
  return real().open(path, flags, mode);
}
ssize_t write(int file, const void* bytes, size_t count) {
  // A process killed during a write leaves a partial file.
  const bool is_last = dies && calls_left.load() == 0 && is_on_disk(file);
  if (is_last && count > 1 && real().write(file, bytes, count / 2) < 0) return -1;
  return disk_refuses(file) ? -1 : real().write(file, bytes, count);
}
int fsync(int file) {
  return disk_refuses(file) ? -1 : real().fsync(file);
}
int close(int file) {
  const bool refused = disk_refuses(file);
  const int result = real().close(file);  // a failed close() also closes the file
  if (refused) errno = ENOSPC;
  return refused ? -1 : result;
}
int rename(const char* from, const char* to) noexcept {
  return disk_refuses(to) ? -1 : real().rename(from, to);
}
int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = real().clock_gettime(clock, time);
  const double off_s = clock == CLOCK_MONOTONIC  ? monotonic_off_s.load()
                       : clock == CLOCK_BOOTTIME ? boot_off_s.load()
                                                 : 0.0;
  if (off_s != 0 && is_our_own(__builtin_return_address(0)))
    time->tv_sec += static_cast<time_t>(off_s);
  return result;
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  if (threads_left.load() != kUnlimited && is_concerned(__builtin_return_address(0)) &&
      runs_out(threads_left)) {
    return EAGAIN;
  }
  return real().pthread_create(thread, attributes, start, argument);
}

}  // extern "C"
