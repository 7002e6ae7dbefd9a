#include "engine/telemetry/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/assert.hpp"

namespace psygen::telemetry {
namespace {

constexpr double kHitchMs = 60.0;
constexpr double kHitchRatio = 1.5;
constexpr double kHitchPauseMs = 200.0;
constexpr double kStutterRatio = 2.5;
constexpr std::size_t kMovingAverageFrames = 60;

std::size_t count_needed(double p) {
  if (p >= 1.0) return 1;
  return static_cast<std::size_t>(std::ceil(1.0 / (1.0 - p) - 1e-6));
}

std::string too_few(std::size_t needed, std::size_t found) {
  return fmt::format("needs at least {} value{}, there {} {}", needed, needed == 1 ? "" : "s",
                     found == 1 ? "is" : "are", found);
}

// `sorted` is not empty.
double interpolated(std::span<const double> sorted, double p) {
  const double h = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(h);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (h - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

std::vector<Figure> percentiles(std::span<const double> values, std::span<const double> ps) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<Figure> result;
  result.reserve(ps.size());
  for (const double p : ps) {
    PSYGEN_ASSERT(p >= 0.0 && p <= 1.0, "a percentile must be between 0 and 1");
    const std::size_t needed = count_needed(p);
    result.push_back(sorted.size() < needed ? Figure::missing(too_few(needed, sorted.size()))
                                            : Figure(interpolated(sorted, p)));
  }
  return result;
}

Figure percentile(std::span<const double> values, double p) {
  return percentiles(values, std::span(&p, 1)).front();
}

Figure mean(std::span<const double> values) {
  if (values.empty()) return Figure::missing(too_few(1, 0));
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Figure largest(std::span<const double> values) {
  if (values.empty()) return Figure::missing(too_few(1, 0));
  return *std::max_element(values.begin(), values.end());
}

namespace {

// 1000 / mean of the frames at or above percentile p.
Figure low_fps(std::span<const double> frame_ms, double p) {
  const Figure from = percentile(frame_ms, p);
  if (!from.has_value()) return from;
  double sum = 0;
  std::size_t count = 0;
  for (const double ms : frame_ms) {
    if (ms < *from) continue;
    sum += ms;
    ++count;
  }
  if (sum <= 0) return Figure::missing("the frames took no time");
  return 1000.0 * static_cast<double>(count) / sum;
}

}  // namespace

Figure low1_fps(std::span<const double> frame_ms) {
  return low_fps(frame_ms, 0.99);
}

Figure low01_fps(std::span<const double> frame_ms) {
  return low_fps(frame_ms, 0.999);
}

Measured<std::uint64_t> hitches(std::span<const double> frame_ms) {
  if (frame_ms.size() < 2) {
    return Measured<std::uint64_t>::missing(too_few(2, frame_ms.size()));
  }
  std::uint64_t count = 0;
  double end = frame_ms[0];
  double last_hitch = -kHitchPauseMs;
  for (std::size_t i = 1; i < frame_ms.size(); ++i) {
    end += frame_ms[i];
    const bool slow = frame_ms[i] > kHitchMs && frame_ms[i] > kHitchRatio * frame_ms[i - 1];
    if (!slow || end - last_hitch < kHitchPauseMs) continue;
    last_hitch = end;
    ++count;
  }
  return count;
}

Figure stutter_percent(std::span<const double> frame_ms) {
  if (frame_ms.size() < 2) return Figure::missing(too_few(2, frame_ms.size()));
  double stutter = 0;
  double total = frame_ms[0];
  for (std::size_t i = 1; i < frame_ms.size(); ++i) {
    const std::size_t window = std::min(i, kMovingAverageFrames);
    const double average = *mean(frame_ms.subspan(i - window, window));
    if (frame_ms[i] > kStutterRatio * average) stutter += frame_ms[i];
    total += frame_ms[i];
  }
  if (total <= 0) return Figure::missing("the frames took no time");
  return 100.0 * stutter / total;
}

}  // namespace psygen::telemetry
