// The usual times of a machine, when no other program disturbs it: of the reference load, and of
// each test. A file of JSON lines keeps the last runs (psygen test --usual); a base has them, too.
// Pure, except for load() and save(); one thread.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/telemetry/machine.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::frametest {

// Missing figures have a reason. `source` is a phrase for messages.
struct UsualLoad {
  telemetry::Figure pair_s;  // wall time of the reference load on all processors
  telemetry::Figure cpu_s;   // processor time of the test's flight
  std::string source = {};
};

// "AMD EPYC, 2 cores, quota 1.5": the part of a fingerprint that decides on times.
std::string machine_name(const telemetry::MachineFacts& machine);

class UsualLoadFile {
 public:
  // Runs that are kept of a test on a machine, and fewest runs for a usual time.
  static constexpr std::size_t kMaxRuns = 40, kFewestRuns = 5;
  static constexpr std::size_t kMaxBytes = std::size_t{4} << 20;

  struct Run {
    std::string machine, test;
    telemetry::Figure pair_s, cpu_s;
  };

  // A missing file has no runs. Fails with kParse, naming the line, for a file that is damaged or
  // has another format, and with kOverBudget above kMaxBytes.
  static core::Result<UsualLoadFile> load(const std::filesystem::path& file);
  // `name` is for messages.
  static core::Result<UsualLoadFile> parse(std::string_view text, const std::string& name);

  // Of the last kMaxRuns runs of the machine the lower quartile of the reference load, and of those
  // of the test the median of the processor time. O(runs).
  UsualLoad usual(const std::string& machine, const std::string& test) const;
  // Forgets the oldest run of this test on this machine above kMaxRuns.
  void add(Run run);
  std::string text() const;
  // Fails with kIo. Of two programs that save at once, the runs of one are kept.
  core::Result<void> save(const std::filesystem::path& file) const;

 private:
  std::deque<Run> runs_;  // oldest first
};

}  // namespace psygen::frametest
