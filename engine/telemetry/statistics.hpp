// The statistics of frame times. The comments here are their definition. Pure functions over
// milliseconds in the order of the frames. Two figures are only comparable when both come from
// here.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/telemetry/measured.hpp"

namespace psygen::telemetry {

// p in [0, 1] of values in any order: h = p(N − 1), linear between the neighbours of h. Missing
// below 1 / (1 − p) values (20 for p95, 100 for p99, 1000 for p999): then no value lies above it.
// O(N), copies the values.
Figure percentile(std::span<const double> values, double p);

// Several percentiles of the same values, sorted once: O(N log N).
std::vector<Figure> percentiles(std::span<const double> values, std::span<const double> ps);

Figure mean(std::span<const double> values);
Figure largest(std::span<const double> values);

// 1000 / mean of the frames at or above p99, in frames per second.
Figure low1_fps(std::span<const double> frame_ms);

// Frames over 60 ms and over 1.5 times the one before, counted when they end at least 200 ms after
// the end of the last one counted. Missing below 2 frames.
Measured<std::uint64_t> hitches(std::span<const double> frame_ms);

// Time in frames over 2.5 times the moving average (the mean of the up to 60 frames before), in
// percent of all time. Missing below 2 frames.
Figure stutter_percent(std::span<const double> frame_ms);

}  // namespace psygen::telemetry
