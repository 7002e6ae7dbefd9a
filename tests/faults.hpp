// Faults of the operating system to order: a disk that is full, threads that cannot be created.
// faults.cpp takes the place of the C library's functions in whatever program it is linked into,
// and goes on to them as long as no fault is asked for. As a library of its own (psygen_faults) it
// is preloaded into whole programs, which get their faults from the environment:
//   PSYGEN_FULL_DISK=FOLDER PSYGEN_CALLS_LEFT=N     FullDisk(FOLDER, N)
//   PSYGEN_THREADS_LEFT=N                           FewThreads(N)
#pragma once

#include <cstddef>
#include <filesystem>

namespace psygen {

// While it lives, each call that makes, writes, flushes, closes or renames a file below `folder`
// fails with ENOSPC, after so many that do not. One at a time.
class FullDisk {
 public:
  FullDisk(const std::filesystem::path& folder, std::size_t calls_left);
  ~FullDisk();
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

  // Whether a call has failed.
  bool was_met() const;
};

// While it lives, only so many threads more can be started from one library: std::threads, or with
// a part of its name those of another one, as of a driver. One at a time.
class FewThreads {
 public:
  explicit FewThreads(std::size_t threads_left, const char* library = "libstdc++");
  ~FewThreads();
  FewThreads(const FewThreads&) = delete;
  FewThreads& operator=(const FewThreads&) = delete;
};

}  // namespace psygen
