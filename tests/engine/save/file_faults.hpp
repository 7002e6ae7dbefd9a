// Faults of the file system below SQLite: its calls that change files can be made to kill the
// process or to find the disk full. One at a time; one thread.
#pragma once

#include <cstddef>

namespace psygen::save::testing {

enum class Fault {
  kKill,      // SIGKILL before the call
  kKillHalf,  // SIGKILL after half of the bytes of a write
  kFullDisk,  // ENOSPC, for this call and all later ones
};

// While it lives, SQLite's calls that write, cut, remove or create files meet the fault, after the
// first `calls_left` of them.
class FileFaults {
 public:
  FileFaults(Fault fault, std::size_t calls_left);
  ~FileFaults();
  FileFaults(const FileFaults&) = delete;
  FileFaults& operator=(const FileFaults&) = delete;
  // Whether a call has met it.
  bool was_met() const;
};

}  // namespace psygen::save::testing
