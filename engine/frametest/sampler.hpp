// Samples the functions that the calling thread executes, by perf(1) as a child process: 4,999
// times per second of processor time. Linux. Main thread only.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::frametest {

inline constexpr double kSamplesPerSecond = 4999;  // no multiple of a frame rate

struct Sample {
  double time_s = 0;  // core::monotonic_seconds()
  std::string function;
};

// Reads the output of `perf script -F time,ip,sym`. Lines of another form are left out. Functions
// without a symbol are "[unknown]".
std::vector<Sample> parse_samples(std::string_view script);

class Sampler {
 public:
  // Starts to sample the calling thread; perf writes into `folder`. Fails with kNoDevice if perf is
  // not installed or may not run here; the message has its reason.
  static core::Result<Sampler> start(const std::filesystem::path& folder);
  // Discards the samples unless stop() was called.
  ~Sampler();
  Sampler(Sampler&& other) noexcept;
  Sampler& operator=(Sampler&&) = delete;

  // Ends perf and returns its samples in the order of time. Fails like start(), and with kIo if the
  // samples cannot be read. Call once.
  core::Result<std::vector<Sample>> stop();

 private:
  explicit Sampler(std::filesystem::path folder) : folder_(std::move(folder)) {}
  core::Result<void> open();
  void end();
  core::Error perf_error() const;

  std::filesystem::path folder_;
  pid_t child_ = -1;
  int control_ = -1;  // socket for commands and answers
};

}  // namespace psygen::frametest
