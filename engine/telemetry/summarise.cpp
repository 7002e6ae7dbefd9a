#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/telemetry/statistics.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {
namespace {

using Frames = std::span<const FrameRecord>;

constexpr double kMinBusySeconds = 0.25;  // below it, a fraction is meaningless
constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr const char* kVirtual = "the clock is virtual";
constexpr const char* kNoFrames = "no frames after the warm-up";

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

// Values of the frames that have one.
std::vector<double> known(Frames frames, std::optional<double> FrameRecord::*field) {
  std::vector<double> values;
  for (const FrameRecord& r : frames)
    if (r.*field) values.push_back(*(r.*field));
  return values;
}

Spread spread_of(std::span<const double> values) {
  constexpr std::array kTwo{0.5, 0.99};
  const std::vector<Figure> p = percentiles(values, kTwo);
  return {p[0], p[1]};
}

template <class Field>
Spread spread(Frames frames, const Field& field) {
  const std::vector<double> values = column(frames, field);
  const bool known = std::ranges::none_of(values, [](double value) { return std::isnan(value); });
  return known ? spread_of(values) : Spread{Figure::missing(kVirtual), Figure::missing(kVirtual)};
}

// True if these frames have no measurements of a real clock.
bool are_virtual(Frames frames) {
  return !frames.empty() && std::isnan(frames.front().main_cpu_ms);
}

// Frames that timing statistics include.
std::vector<FrameRecord> timed(Frames frames) {
  std::vector<FrameRecord> kept(frames.begin(), frames.end());
  std::erase_if(kept, [](const FrameRecord& r) { return r.apart != Apart::kNo; });
  return kept;
}

// Percentage of the image that is missing or too coarse.
double coarse_percent(const FrameRecord& r) {
  return std::max(r.missing_pixels_percent, r.too_coarse_percent);
}

// Flight time from this frame to the next; the last frame's own time.
double length_s(Frames frames, std::size_t i) {
  return i + 1 < frames.size() ? frames[i + 1].time_s - frames[i].time_s
                               : frames[i].frame_ms * 1e-3;
}

void summarise_run(Summary& s, Frames frames, const FrameLog& log) {
  s.run.frames = log.frames().size() + log.dropped_frames();
  s.run.measured_frames = frames.size();
  for (const FrameRecord& r : frames)
    ++s.run.apart_frames[static_cast<std::size_t>(r.apart)];
  s.run.timed_frames = s.run.apart_frames[0];
  if (!log.frames().empty()) {
    const FrameRecord& last = log.frames().back();
    s.run.seconds = last.time_s + last.frame_ms * 1e-3;
  }
  double real_s = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    real_s += frames[i].frame_ms * 1e-3;
    s.run.measured_seconds += length_s(frames, i);
  }
  s.run.real_seconds = frames.empty() ? Figure::missing(kNoFrames) : Figure(real_s);
}

void summarise_device(Summary& s, Frames frames) {
  const std::vector<double> ms = known(frames, &FrameRecord::gpu_ms);
  const bool is_virtual = are_virtual(frames);
  if (is_virtual || (ms.empty() && !s.device.timestamps)) {
    const Figure none = Figure::missing(is_virtual ? kVirtual : "the GPU has no timestamps");
    s.gpu_ms = {none, none, none, none};
    return;
  }
  s.gpu_ms = {percentile(ms, 0.5), percentile(ms, 0.99), largest(ms),
              percentile(known(frames, &FrameRecord::gpu_shadows_ms), 0.5)};
}

// Neighbouring rows of a log, and the flight time between them.
struct Rows {
  const FrameLog& log;
  std::size_t first, end;
  double from_s, until_s;

  Frames frames() const { return log.frames().subspan(first, end - first); }
};

// Uses the timed frames.
void summarise_systems(Summary& s, const Rows& rows) {
  const FrameLog& log = rows.log;
  const Frames frames = log.frames();
  for (std::size_t system = 0; system < log.systems().size(); ++system) {
    std::vector<double> ms;
    for (std::size_t i = rows.first; i < rows.end; ++i) {
      const float value = log.system_ms(i)[system];
      if (frames[i].apart == Apart::kNo && !std::isnan(value)) ms.push_back(double{value});
    }
    const Figure none = Figure::missing(kVirtual);
    const Spread p = are_virtual(frames) ? Spread{none, none} : spread_of(ms);
    s.system_ms.push_back({log.systems()[system], p.p50, p.p99});
  }
}

Distribution distribution_of(std::span<const double> values) {
  constexpr std::array kPercentiles{0.5, 0.95, 0.99};
  const std::vector<Figure> p = percentiles(values, kPercentiles);
  return {mean(values), p[0], p[1], p[2], largest(values)};
}

// Times between frames as the display gets them. `frames` are the timed ones.
void summarise_presents(Summary& s, Frames frames) {
  const auto none = [](const char* reason) {
    const Figure missing = Figure::missing(reason);
    return Distribution{missing, missing, missing, missing, missing};
  };
  const std::vector<double> between = known(frames, &FrameRecord::between_presents_ms);
  std::vector<double> errors = known(frames, &FrameRecord::animation_error_ms);
  for (double& error : errors)
    error = std::abs(error);
  const bool is_virtual = are_virtual(frames);
  s.between_presents_ms = is_virtual        ? none(kVirtual)
                          : between.empty() ? none("no two frames in turn were presented")
                                            : distribution_of(between);
  s.animation_error_ms = is_virtual                     ? none(kVirtual)
                         : s.run.fixed_step.has_value() ? none("the flight has a fixed step")
                         : errors.empty() ? none("no two frames in turn were presented")
                                          : distribution_of(errors);
}

// Uses the timed frames.
void summarise_passes(Summary& s, const Rows& rows) {
  const Frames frames = rows.log.frames();
  for (std::size_t pass = 0; pass < rows.log.passes().size(); ++pass) {
    std::vector<double> ms;
    for (std::size_t i = rows.first; i < rows.end; ++i) {
      const float value = rows.log.pass_ms(i)[pass];
      if (frames[i].apart == Apart::kNo && !std::isnan(value)) ms.push_back(double{value});
    }
    PassTimes times{rows.log.passes()[pass], percentile(ms, 0.5), percentile(ms, 0.99),
                    largest(ms)};
    if (ms.empty())
      times.p50 = times.p99 = times.max =
          Figure::missing(are_virtual(frames)    ? kVirtual
                          : !s.device.timestamps ? "the GPU has no timestamps"
                          : !s.device.pass_times ? "passes were not measured (--pass-times)"
                                                 : "no frame's time arrived");
    s.pass_ms.push_back(std::move(times));
  }
}

Count device_peak(Frames frames) {
  std::optional<std::uint64_t> peak;
  for (const FrameRecord& r : frames)
    if (r.device_bytes) peak = std::max(peak.value_or(0), *r.device_bytes);
  return peak ? Count(*peak)
              : Count::missing(are_virtual(frames) ? kVirtual : "no frame was drawn");
}

// `frames` are the timed ones.
void summarise_times(Summary& s, Frames frames) {
  const std::vector<double> ms = column(frames, [](const auto& r) { return r.frame_ms; });
  constexpr std::array kPercentiles{0.5, 0.95, 0.99, 0.999};
  const std::vector<Figure> p = percentiles(ms, kPercentiles);
  s.frame_ms = {mean(ms), p[0], p[1], p[2], p[3], largest(ms)};
  s.low1_fps = low1_fps(ms);
  s.low01_fps = low01_fps(ms);
  s.hitches = hitches(ms);
  s.stutter_percent = stutter_percent(ms);
  s.wait_ms = {spread(frames, [](const auto& r) { return r.wait_ms(); }),
               spread(frames, [](const auto& r) { return r.device_wait_ms; }),
               spread(frames, [](const auto& r) { return r.acquire_ms; }),
               spread(frames, [](const auto& r) { return r.present_ms; })};
  s.record_ms = spread(frames, [](const auto& r) { return r.record_ms; });
  summarise_device(s, frames);
  summarise_presents(s, frames);
}

// Statistics of drawing, over all measured frames.
void summarise_drawing(Summary& s, Frames frames) {
  s.draw.triangles_p50 = percentile(column(frames, [](const auto& r) { return r.triangles; }), 0.5);
  s.draw.draws_p50 = percentile(column(frames, [](const auto& r) { return r.draws; }), 0.5);
  constexpr double kRaised = 1.005;  // ratio to the requested error
  const double asked = s.run.error_pixels * kRaised;
  const auto error = column(frames, [](const auto& r) { return r.error_pixels; });
  s.detail.p50_pixels = percentile(error, 0.5);
  s.detail.max_pixels = largest(error);
  s.detail.raised_by_memory =
      total(frames, [](const auto& r) { return r.memory_factor > kRaised ? 1 : 0; });
  s.detail.raised_for_target = total(frames, [asked](const auto& r) {
    const bool coarser = asked > 0 && r.error_pixels > asked * r.memory_factor;
    return coarser || r.resolution < 1 ? 1 : 0;
  });
  const auto resolution = column(frames, [](const auto& r) { return r.resolution; });
  s.detail.resolution_p50 = percentile(resolution, 0.5);
  s.detail.resolution_min = percentile(resolution, 0.0);
  s.detail.refused_frames =
      total(frames, [](const auto& r) { return r.requests_refused > 0 ? 1 : 0; });
}

void summarise_missing(Summary& s, const Rows& rows) {
  const Frames frames = rows.frames();
  const auto nodes = column(
      frames, [](const auto& r) { return std::uint64_t{r.holes} + std::uint64_t{r.coarse_nodes}; });
  const auto pixels = column(frames, [](const auto& r) { return r.missing_pixels_percent; });
  s.missing.frames = total(frames, [](const auto& r) { return r.holes > 0 ? 1 : 0; });
  s.missing.nodes_p99 = percentile(nodes, 0.99);
  s.missing.pixels_p99_percent = percentile(pixels, 0.99);
  s.missing.pixels_max_percent = largest(pixels);
  const auto coarse = column(frames, coarse_percent);
  s.missing.coarse_p99_percent = percentile(coarse, 0.99);
  s.missing.coarse_max_percent = largest(coarse);
  const auto many = std::ranges::count_if(coarse, [](double v) { return v > kCoarsePercent; });
  s.missing.coarse_frames =
      frames.empty() ? Count::missing(kNoFrames) : Count(static_cast<std::uint64_t>(many));
  double seconds = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
    seconds += coarse[i] > kCoarsePercent ? length_s(frames, i) : 0.0;
  s.missing.coarse_seconds = frames.empty() ? Figure::missing(kNoFrames) : Figure(seconds);
  const std::vector<double> waits =
      rows.log.time_to_visible_ms().values_since(rows.from_s, rows.until_s);
  const Spread wait = spread_of(waits);
  s.missing.time_to_visible_ms = {wait.p50, wait.p99, largest(waits)};
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

// Fraction of the modelers' processors that synthesis used, in frames for which `counts` is true.
template <class Counts>
Figure busy_percent(Frames frames, std::uint32_t modelers, const Counts& counts) {
  double busy_s = 0, real_s = 0;
  for (const FrameRecord& r : frames) {
    if (r.apart == Apart::kPicture)
      return Figure::missing(
          "modelers continue while an image is written, which no frame's time includes");
    if (!counts(r)) continue;
    busy_s += r.synthesis_seconds;
    real_s += r.frame_ms * 1e-3;
  }
  if (!(real_s >= kMinBusySeconds) || modelers == 0)
    return Figure::missing("the total time of such frames is too short");
  return 100 * busy_s / (real_s * modelers);
}

void summarise_synthesis(Summary& s, const Rows& rows) {
  const Frames frames = rows.frames();
  const FrameLog& log = rows.log;
  auto& synthesis = s.synthesis;
  synthesis.models = total(frames, [](const auto& r) { return r.models_synthesised; });
  synthesis.triangles = total(frames, [](const auto& r) { return r.triangles_synthesised; });
  synthesis.bytes = total(frames, [](const auto& r) { return r.bytes_synthesised; });
  double seconds = 0;
  for (const FrameRecord& r : frames)
    seconds += r.synthesis_seconds;
  synthesis.seconds = frames.empty() ? Figure::missing(kNoFrames) : Figure(seconds);
  synthesis.failed = total(log.frames(), [](const auto& r) { return r.models_failed; });
  synthesis.busy_percent = busy_percent(frames, s.run.modelers, [](const auto&) { return true; });
  synthesis.coarse_busy_percent = busy_percent(
      frames, s.run.modelers, [](const auto& r) { return coarse_percent(r) > kCoarsePercent; });
  synthesis.triangles_per_second =
      seconds > 0 ? Figure(static_cast<double>(*synthesis.triangles) / seconds)
                  : Figure::missing("nothing was synthesised after the warm-up");
  const std::vector<double> errors =
      log.cost_error_percent().values_since(rows.from_s, rows.until_s);
  synthesis.cost_error_percent = {percentile(errors, 0.5), percentile(errors, 0.95)};
}

OwnFigureTimes own_times(const Rows& rows, std::size_t figure) {
  OwnFigureTimes times;
  times.info = rows.log.figures()[figure];
  const bool duration = times.info.kind == FigureKind::kDuration;
  std::vector<double> values;
  for (std::size_t i = rows.first; i < rows.end; ++i) {
    if (duration && rows.log.frames()[i].apart != Apart::kNo) continue;
    const double value = rows.log.own(i)[figure];
    if (!std::isnan(value)) values.push_back(value);
  }
  times.frames = values.size();
  if (values.empty()) {
    const Figure none =
        Figure::missing(duration && are_virtual(rows.frames()) ? kVirtual : "no frame had a value");
    times.mean = times.min = times.p50 = times.p95 = times.p99 = times.max = none;
    return times;
  }
  constexpr std::array kPercentiles{0.0, 0.5, 0.95, 0.99};
  const std::vector<Figure> p = percentiles(values, kPercentiles);
  times.mean = mean(values);
  times.min = p[0];
  times.p50 = p[1];
  times.p95 = p[2];
  times.p99 = p[3];
  times.max = largest(values);
  return times;
}

// What is measured per frame.
void summarise_rows(Summary& s, const Rows& rows, const RunFacts& facts) {
  const Frames frames = rows.frames();
  summarise_run(s, frames, rows.log);
  summarise_times(s, timed(frames));
  summarise_systems(s, rows);
  summarise_passes(s, rows);
  s.memory.device_peak_bytes = device_peak(frames);
  summarise_drawing(s, frames);
  summarise_missing(s, rows);
  summarise_synthesis(s, rows);
  for (std::size_t i = 0; i < rows.log.figures().size(); ++i) {
    s.figures.push_back(own_times(rows, i));
    if (i < facts.invalid_values.size()) s.figures.back().invalid = facts.invalid_values[i];
  }
}

std::vector<MarkFacts> mark_facts(const FrameLog& log) {
  std::vector<MarkFacts> marks;
  for (const FrameMark& mark : log.marks()) {
    auto found = std::ranges::find(marks, mark.name, &MarkFacts::name);
    if (found == marks.end()) {
      const FrameRecord& frame = log.frames()[mark.row];
      found = marks.insert(found, {mark.name, 0, frame.index, frame.time_s});
    }
    ++found->count;
  }
  return marks;
}

// The section's frames after the warm-up.
Section section_of(const FrameLog& log, const SectionRange& range, const RunFacts& facts,
                   const Summary& whole) {
  Section section{range, {}, {}, {}, {}};
  section.frames.run = whole.run;
  section.frames.device = whole.device;
  section.frames.run.apart_frames = {};
  const auto rows = find_section(log, range);
  const Frames frames = log.frames();
  const std::size_t warm = frames.size() - log.frames_since(whole.run.warmup_seconds).size();
  const auto [from, to] = rows.value.value_or(std::pair{warm, warm});
  const std::size_t first = std::max(from, warm), end = std::max(to, warm);
  section.missing = rows.reason;
  if (rows.has_value() && first == end) section.missing = "the section lies within the warm-up";
  const auto time_s = [&](std::size_t row) {
    return row < frames.size() ? frames[row].time_s : whole.run.seconds;
  };
  if (section.missing.empty()) {
    section.start_s = time_s(first);
    section.end_s = time_s(end);
  }
  summarise_rows(section.frames, {log, first, end, time_s(first), time_s(end)}, facts);
  return section;
}

}  // namespace

ReferenceRatios reference_ratios(const Summary& s) {
  const auto ratio = [](const Figure& figure, double scale, const Figure& reference) {
    if (!reference.has_value() || !figure.has_value())
      return Figure::missing(reference.has_value() ? figure.reason : reference.reason);
    return Figure(*figure * scale / *reference);
  };
  const Figure& pair_s = s.reference.pair.wall_s;
  return {ratio(s.load.cpu_seconds, 1, cpu_seconds_of(s.reference)),
          ratio(s.frame_ms.p50, 1e-3, pair_s), ratio(s.frame_ms.p99, 1e-3, pair_s)};
}

Measured<std::pair<std::size_t, std::size_t>> find_section(const FrameLog& log,
                                                           const SectionRange& range) {
  using Found = Measured<std::pair<std::size_t, std::size_t>>;
  const std::span<const FrameMark> marks = log.marks();
  const auto from = std::ranges::find(marks, range.from, &FrameMark::name);
  if (from == marks.end())
    return Found::missing(fmt::format("no frame has the mark '{}'", range.from));
  if (range.to == kEndOfRun) return std::pair{from->row, log.frames().size()};
  const auto to = std::find_if(from + 1, marks.end(), [&](const FrameMark& mark) {
    return mark.name == range.to && mark.row > from->row;
  });
  if (to == marks.end())
    return Found::missing(
        fmt::format("no frame after the mark '{}' has the mark '{}'", range.from, range.to));
  return std::pair{from->row, to->row};
}

Summary summarise(const FrameLog& log, const RunFacts& facts, double warmup_s) {
  const Frames frames = log.frames_since(warmup_s);
  Summary s;
  s.world = facts.world;
  s.device = facts.device;
  s.machine = facts.machine;
  s.build = facts.build;
  s.load = facts.load;
  s.reference = facts.reference;
  static_cast<RunSettings&>(s.run) = facts.run;
  s.run.warmup_seconds = warmup_s;
  const std::size_t all = log.frames().size();
  summarise_rows(s, {log, all - frames.size(), all, warmup_s, kForever}, facts);
  summarise_cache(s, frames, log, facts);
  s.synthesis.share_drawn = facts.share_drawn;
  s.draw.floor_ratio = facts.floor_ratio;
  s.memory.peak_rss_bytes = facts.peak_rss_bytes;
  s.hash.world = facts.world_hash;
  s.hash.types = facts.types_hash;
  s.hash.path = facts.path_hash;
  s.hash.images = facts.images_hash;
  s.marks = mark_facts(log);
  s.ignored_marks = facts.ignored_marks;
  for (const SectionRange& range : facts.sections)
    s.sections.push_back(section_of(log, range, facts, s));
  return s;
}

}  // namespace psygen::telemetry
