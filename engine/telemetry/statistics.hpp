// Statistics of frame times. The comments here are their definitions: only numbers computed here
// are comparable. Pure functions over milliseconds in the order of the frames.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace psygen::telemetry {

// A value, or the reason for its absence: too few frames, an endless world, a GPU without
// timestamps. In summary.json it becomes a number, or null with a reason. Not an Error: nothing
// failed. A plain value.
template <class T>
struct Measured {
  std::optional<T> value;
  std::string reason = "not measured in this run";  // a phrase; empty if there is a value

  // Missing with the default reason, or known. The conversion is implicit on purpose.
  Measured() = default;
  Measured(T known) : value(std::move(known)), reason() {}
  // Missing for this reason.
  static Measured missing(std::string why) {
    Measured result;
    result.reason = std::move(why);
    return result;
  }

  // True if the value is known, which operator* requires.
  bool has_value() const { return value.has_value(); }
  const T& operator*() const { return *value; }
  friend bool operator==(const Measured&, const Measured&) = default;
};

// A measured real number.
using Figure = Measured<double>;

// Percentile p in [0, 1] of values in any order: h = p(N − 1), linear between the neighbours of h.
// Missing below 1 / (1 − p) values (20 for p95, 100 for p99, 1000 for p999), because no value would
// lie above it. O(N log N), copies the values.
Figure percentile(std::span<const double> values, double p);

// Several percentiles of the same values, sorted once: O(N log N).
std::vector<Figure> percentiles(std::span<const double> values, std::span<const double> ps);

// Mean and largest value. Missing without values. O(N).
Figure mean(std::span<const double> values);
Figure largest(std::span<const double> values);

// 1000 / mean of the frames at or above p99, or p99.9, in frames per second.
Figure low1_fps(std::span<const double> frame_ms);
Figure low01_fps(std::span<const double> frame_ms);

// Counts frames over 60 ms and over 1.5 times the previous frame. A hitch counts only if it ends at
// least 200 ms after the end of the last counted one. Missing below 2 frames. O(N).
Measured<std::uint64_t> hitches(std::span<const double> frame_ms);

// Time in frames longer than 2.5 times the moving average (the mean of up to 60 previous frames),
// in percent of the total time. Missing below 2 frames. O(60 N).
Figure stutter_percent(std::span<const double> frame_ms);

}  // namespace psygen::telemetry
