#include <algorithm>
#include <cmath>

#include "engine/telemetry/statistics.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {
namespace {

using Frames = std::span<const FrameRecord>;

constexpr const char* kNoFrames = "no frame is left after the warm-up";

// One value per frame.
template <class Field>
std::vector<double> column(Frames frames, const Field& field) {
  std::vector<double> values(frames.size());
  std::transform(frames.begin(), frames.end(), values.begin(),
                 [&](const FrameRecord& r) { return static_cast<double>(field(r)); });
  return values;
}

template <class Field>
Count total(Frames frames, const Field& field) {
  if (frames.empty()) return Count::missing(kNoFrames);
  std::uint64_t sum = 0;
  for (const FrameRecord& r : frames)
    sum += static_cast<std::uint64_t>(field(r));
  return sum;
}

Figure percentile_of_samples(const SampleSet& samples, double warmup_s, double p) {
  return percentile(samples.values_since(warmup_s), p);
}

void summarise_frames(Summary& s, Frames frames, const FrameLog& log) {
  const std::vector<double> ms = column(frames, [](const auto& r) { return r.frame_ms; });
  constexpr std::array kPercentiles{0.5, 0.95, 0.99, 0.999};
  const std::vector<Figure> p = percentiles(ms, kPercentiles);
  s.frame_ms = {mean(ms), p[0], p[1], p[2], p[3], largest(ms)};
  s.low1_fps = low1_fps(ms);
  s.hitches = hitches(ms);
  s.stutter_percent = stutter_percent(ms);
  for (std::size_t i = 0; i < log.systems().size(); ++i) {
    const auto system = column(frames, [i](const auto& r) { return r.system_ms[i]; });
    constexpr std::array kTwo{0.5, 0.99};
    const std::vector<Figure> figures = percentiles(system, kTwo);
    s.system_ms.push_back({log.systems()[i], figures[0], figures[1]});
  }
  const auto triangles = column(frames, [](const auto& r) { return r.triangles; });
  const auto draws = column(frames, [](const auto& r) { return r.draws; });
  s.draw.triangles_p50 = percentile(triangles, 0.5);
  s.draw.draws_p50 = percentile(draws, 0.5);
}

void summarise_missing(Summary& s, Frames frames, const FrameLog& log, double warmup_s) {
  const auto nodes = column(
      frames, [](const auto& r) { return std::uint64_t{r.holes} + std::uint64_t{r.coarse_nodes}; });
  const auto pixels = column(frames, [](const auto& r) { return r.missing_pixels_percent; });
  s.missing.frames = total(frames, [](const auto& r) { return r.holes > 0 ? 1 : 0; });
  s.missing.nodes_p99 = percentile(nodes, 0.99);
  s.missing.pixels_p99_percent = percentile(pixels, 0.99);
  s.missing.pixels_max_percent = largest(pixels);
  const std::vector<double> waits = log.time_to_visible_ms().values_since(warmup_s);
  constexpr std::array kTwo{0.5, 0.99};
  const std::vector<Figure> p = percentiles(waits, kTwo);
  s.missing.time_to_visible_ms = {p[0], p[1], largest(waits)};
}

void summarise_cache(Summary& s, Frames frames, const FrameLog& log, const RunFacts& facts) {
  s.cache.budget_bytes = facts.cache_budget_bytes;
  s.cache.peak_bytes = facts.cache_peak_bytes;
  if (!s.cache.peak_bytes.has_value() && !log.frames().empty()) {
    const auto by_bytes = [](const auto& a, const auto& b) {
      return a.cache_bytes < b.cache_bytes;
    };
    const auto all = log.frames();
    s.cache.peak_bytes = std::max_element(all.begin(), all.end(), by_bytes)->cache_bytes;
  }
  s.cache.hits = total(frames, [](const auto& r) { return r.cache_hits; });
  s.cache.misses = total(frames, [](const auto& r) { return r.cache_misses; });
  s.cache.evictions = total(frames, [](const auto& r) { return r.cache_evictions; });
  s.cache.regenerations = total(frames, [](const auto& r) { return r.cache_regenerations; });
  s.cache.prefetch_hit_percent = facts.prefetch_hit_percent;
}

void summarise_synthesis(Summary& s, Frames frames, const FrameLog& log, double warmup_s) {
  auto& synthesis = s.synthesis;
  synthesis.models = total(frames, [](const auto& r) { return r.models_synthesised; });
  synthesis.triangles = total(frames, [](const auto& r) { return r.triangles_synthesised; });
  synthesis.bytes = total(frames, [](const auto& r) { return r.bytes_synthesised; });
  double seconds = 0;
  for (const FrameRecord& r : frames)
    seconds += r.synthesis_seconds;
  synthesis.seconds = frames.empty() ? Figure::missing(kNoFrames) : Figure(seconds);
  synthesis.triangles_per_second =
      seconds > 0 ? Figure(static_cast<double>(*synthesis.triangles) / seconds)
                  : Figure::missing("nothing was synthesised after the warm-up");
  synthesis.cost_error_percent = {percentile_of_samples(log.cost_error_percent(), warmup_s, 0.5),
                                  percentile_of_samples(log.cost_error_percent(), warmup_s, 0.95)};
}

}  // namespace

Summary summarise(const FrameLog& log, const RunFacts& facts, double warmup_s) {
  const Frames frames = log.frames_since(warmup_s);
  Summary s;
  s.world = facts.world;
  s.device = facts.device;
  static_cast<RunSettings&>(s.run) = facts.run;
  s.run.frames = log.frames().size() + log.dropped_frames();
  s.run.warmup_seconds = warmup_s;
  s.run.measured_frames = frames.size();
  if (!log.frames().empty()) {
    const FrameRecord& last = log.frames().back();
    s.run.seconds = last.time_s + last.frame_ms * 1e-3;
  }
  summarise_frames(s, frames, log);
  summarise_missing(s, frames, log, warmup_s);
  summarise_cache(s, frames, log, facts);
  summarise_synthesis(s, frames, log, warmup_s);
  s.synthesis.share_drawn = facts.share_drawn;
  s.draw.floor_ratio = facts.floor_ratio;
  s.memory.peak_rss_bytes = facts.peak_rss_bytes;
  s.hash.world = facts.world_hash;
  s.hash.images = facts.images_hash;
  return s;
}

}  // namespace psygen::telemetry
