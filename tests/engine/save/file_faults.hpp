// Injects faults below SQLite: calls that change files kill the process or find the disk full. One
// at a time; one thread.
#pragma once

#include <cstddef>

namespace psygen::save::testing {

enum class Fault {
  kKill,      // SIGKILL before the call
  kKillHalf,  // SIGKILL after half of the bytes of a write
  kFullDisk,  // ENOSPC, for this call and all later ones
};

// During its lifetime, SQLite's calls that write, truncate, remove or create files meet the fault,
// after the first `calls_left` of them.
class FileFaults {
 public:
  FileFaults(Fault fault, std::size_t calls_left);
  ~FileFaults();
  FileFaults(const FileFaults&) = delete;
  FileFaults& operator=(const FileFaults&) = delete;
  // True if a call has met the fault.
  bool was_met() const;
};

}  // namespace psygen::save::testing
