// The fingerprint of a run: the machine and the build that made it, and the load beside it. Two
// runs say something about the program only if machine and build options are the same. Linux. Main
// thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {

using MeasuredText = Measured<std::string>;

struct MachineFacts {
  MeasuredText cpu;           // model name
  MeasuredText cpu_features;  // names of vector and arithmetic extensions, in order, with blanks
  std::uint64_t cores = 1;    // processors that the affinity allows
  Figure quota_cores;         // processors' time that control groups allow; missing if unlimited
  Measured<std::uint64_t> memory_bytes;
  MeasuredText governor;  // of the processor's frequency
  MeasuredText kernel;    // release of the operating system's kernel
};

struct BuildFacts {
  std::string version;    // of psygen
  std::string compiler;   // "GCC 12.2.0"
  std::string type;       // "Release", …
  MeasuredText revision;  // of the program's source, as `git rev-parse` tells it
  Measured<bool> clean;   // no file under version control had changed
};

// Load of the machine before and during a run.
struct LoadFacts {
  Figure before;         // mean number of running threads in the minute before
  Figure others_cores;   // processors that other programs used during the run, mean
  Figure steal_percent;  // of all processors' time, taken by other virtual machines
  Figure cpu_seconds;    // processor time of this process during the run, user and system
};

// Reads /proc, /sys and the control groups below `root`, which is "/" but for tests.
MachineFacts machine_facts(const std::filesystem::path& root = "/");

// The build of this program. Its revision is known if CMake's psygen_revision() was called for the
// program.
BuildFacts build_facts();

// Measures the load from its creation on.
class LoadMeter {
 public:
  explicit LoadMeter(std::filesystem::path root = "/");

  // Figures are missing if /proc cannot be read.
  LoadFacts facts() const;

 private:
  struct Times {
    bool known = false;
    double all_s = 0, busy_s = 0, steal_s = 0;  // of all processors since the start of the machine
    double own_s = 0;                           // of this process
    double real_s = 0;
  };
  Times now() const;

  std::filesystem::path root_;
  Times start_;
  Figure before_;
};

}  // namespace psygen::telemetry
