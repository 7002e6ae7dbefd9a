// Trace of a run: spans on named tracks (the main thread's systems, each modeler's jobs) and
// counters over time, written as Chrome trace events for Perfetto and chrome://tracing. Adding is
// O(1) and allocates only when a track doubles. Memory is bounded: each track keeps its newest
// spans. Main thread only: modelers return their times with their results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {
class FileReplacement;
}

namespace psygen::telemetry {

// Trace of one run.
class TraceLog {
 public:
  // Ids of a track or counter, and of a span's name. Valid for this log.
  using Track = std::uint16_t;
  using Name = std::uint16_t;
  // Value for spans without an argument.
  static constexpr std::uint64_t kNoArgument = UINT64_MAX;

  // Stores at most `max_spans_per_track` (at least 1) spans or values per track.
  explicit TraceLog(std::size_t max_spans_per_track = std::size_t{1} << 16);

  // Adds a row of the viewer, for spans or for a counter, in the order of creation. At most 65,535
  // in total; more end the program.
  Track add_track(std::string_view name);
  Track add_counter(std::string_view name);
  // Id of a span's name; equal texts have equal ids. At most 65,535 names. Call it outside the hot
  // path.
  Name intern(std::string_view name);

  // Adds a span or a counter's value. Times are core::monotonic_seconds(). Spans of a track may
  // nest but not overlap. Viewers show `argument` with the span: a frame's number, a model's key.
  // Ignores spans that end before they start and values that are not finite.
  void add_span(Track track, Name name, double start_s, double end_s,
                std::uint64_t argument = kNoArgument);
  void add_value(Track counter, double time_s, double value);

  // Number of spans and values replaced by newer ones. O(tracks).
  std::uint64_t dropped_count() const;
  // Writes trace.json. The earliest stored time becomes 0. Fails with kIo and the path.
  core::Result<void> write(const std::filesystem::path& path) const;

 private:
  struct Span {
    double start_s;
    double length_or_value;  // seconds, or a counter's value
    std::uint64_t argument;
    Name name;
  };
  struct Ring {
    std::string name;
    bool is_counter = false;
    std::vector<Span> spans;
    std::uint64_t added = 0;
  };
  Track add_ring(std::string_view name, bool is_counter);
  void add(Ring& ring, const Span& span);
  double earliest_s() const;
  void write_ring(core::FileReplacement& file, std::size_t track, double origin_s,
                  std::span<const std::string> quoted_names) const;

  std::size_t max_spans_;
  std::vector<Ring> rings_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, Name> ids_;
};

}  // namespace psygen::telemetry
