// Operating system faults on request: a full disk, threads that cannot be created, clocks that
// jump. faults.cpp replaces the C library's functions in any program that links it, and forwards to
// them while no fault is requested. As a library of its own (psygen_faults) it is preloaded into
// whole programs, which take their faults from the environment:
//   PSYGEN_FULL_DISK=FOLDER PSYGEN_CALLS_LEFT=N     FullDisk(FOLDER, N)
//   PSYGEN_DIES=1 in addition: kill -9 at that call instead, in the middle of a write
//   PSYGEN_THREADS_LEFT=N                           FewThreads(N)
#pragma once

#include <cstddef>
#include <filesystem>

namespace psygen {

// While it lives, calls that create, write, flush, close or rename a file below `folder` fail with
// ENOSPC, after the first `calls_left` of them. One at a time.
class FullDisk {
 public:
  // The disk is full from now until the object ends.
  FullDisk(const std::filesystem::path& folder, std::size_t calls_left);
  // The disk has room again.
  ~FullDisk();
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

  // Returns true if a call has failed.
  bool was_met() const;
};

// While it lives, only `threads_left` more threads can be started by one library: the C++ library
// (std::thread), or another one that is named by a part of its file name, such as a driver. One at
// a time.
class FewThreads {
 public:
  // Threads are limited from now until the object ends.
  explicit FewThreads(std::size_t threads_left, const char* library = "libstdc++");
  // Threads are unlimited again.
  ~FewThreads();
  FewThreads(const FewThreads&) = delete;
  FewThreads& operator=(const FewThreads&) = delete;
};

// While it lives, the program itself (not its libraries) reads clocks that are off by these
// seconds: CLOCK_MONOTONIC, and CLOCK_BOOTTIME, which also counts time in which the machine is
// suspended. One at a time.
class WrongClock {
 public:
  WrongClock(double monotonic_s, double boot_s);
  ~WrongClock();
  WrongClock(const WrongClock&) = delete;
  WrongClock& operator=(const WrongClock&) = delete;
};

}  // namespace psygen
