// Finds the frames of a flight that missed a budget most: the budget's field selects a column of
// the log.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>

#include "engine/frametest/budget_fields.hpp"
#include "engine/frametest/failure.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::frametest {
namespace {

using telemetry::FrameLog;
using telemetry::FrameRecord;

constexpr double kApartSeconds = 0.5;
constexpr std::string_view kSystemPrefix = "system_ms.", kFigurePrefix = "figures.",
                           kPassPrefix = "pass_ms.";

// Value of a frame for measurements whose names begin with `prefix`. The first match counts.
using Of = double (*)(const FrameRecord&);
struct Measure {
  std::string_view prefix, unit;
  Of of;
  bool time = false;  // excluded frames do not count
};

template <auto Field>
double its(const FrameRecord& record) {
  return static_cast<double>(record.*Field);
}
template <auto Field>
double if_known(const FrameRecord& record) {
  return (record.*Field).value_or(std::numeric_limits<double>::quiet_NaN());
}
double waiting(const FrameRecord& record) {
  return record.wait_ms();
}
double rate(const FrameRecord& record) {
  return 1000 / record.frame_ms;
}
double holes_and_coarse(const FrameRecord& record) {
  return static_cast<double>(record.holes) + record.coarse_nodes;
}
double missing_or_coarse(const FrameRecord& record) {
  return std::max(record.missing_pixels_percent, record.too_coarse_percent);
}

double animation_error(const FrameRecord& record) {
  return std::abs(if_known<&FrameRecord::animation_error_ms>(record));
}
double device_bytes(const FrameRecord& record) {
  return record.device_bytes ? static_cast<double>(*record.device_bytes)
                             : std::numeric_limits<double>::quiet_NaN();
}

using R = FrameRecord;
constexpr std::array kMeasures = std::to_array<Measure>({
    {"frame_ms.", "ms", its<&R::frame_ms>, true},
    {"hitches", "ms", its<&R::frame_ms>, true},
    {"stutter_percent", "ms", its<&R::frame_ms>, true},
    {"low1_fps", "frames/s", rate, true},
    {"low01_fps", "frames/s", rate, true},
    {"between_presents_ms.", "ms", if_known<&R::between_presents_ms>, true},
    {"animation_error_ms.", "ms", animation_error, true},
    {"memory.device_peak_bytes", "bytes", device_bytes},
    {"wait_ms.device", "ms", its<&R::device_wait_ms>, true},
    {"wait_ms.acquire", "ms", its<&R::acquire_ms>, true},
    {"wait_ms.present", "ms", its<&R::present_ms>, true},
    {"wait_ms.", "ms", waiting, true},
    {"record_ms.", "ms", its<&R::record_ms>, true},
    {"gpu_ms.shadows", "ms", if_known<&R::gpu_shadows_ms>, true},
    {"gpu_ms.", "ms", if_known<&R::gpu_ms>, true},
    {"missing.frames", "holes", its<&R::holes>},
    {"missing.nodes", "holes and coarse nodes", holes_and_coarse},
    {"missing.pixels", "% of the image missing", its<&R::missing_pixels_percent>},
    {"missing.", "% of the image missing or too coarse", missing_or_coarse},
    {"picture.", "% of the picture missing or too coarse", missing_or_coarse},
    {"detail.refused", "requests rejected", its<&R::requests_refused>},
    {"detail.raised_by_memory", "times the error", its<&R::memory_factor>},
    {"detail.resolution", "of the resolution", its<&R::resolution>},
    {"detail.", "pixels of error", its<&R::error_pixels>},
    {"cache.peak_bytes", "bytes", its<&R::cache_bytes>},
    {"cache.hits", "hits", its<&R::cache_hits>},
    {"cache.misses", "misses", its<&R::cache_misses>},
    {"cache.evictions", "evictions", its<&R::cache_evictions>},
    {"cache.regenerations", "regenerations", its<&R::cache_regenerations>},
    {"synthesis.failed", "models failed", its<&R::models_failed>},
    {"synthesis.triangles", "triangles synthesised", its<&R::triangles_synthesised>},
    {"synthesis.models", "models synthesised", its<&R::models_synthesised>},
    {"synthesis.bytes", "bytes synthesised", its<&R::bytes_synthesised>},
    {"synthesis.seconds", "s of synthesis", its<&R::synthesis_seconds>},
    {"draw.triangles", "triangles", its<&R::triangles>},
    {"draw.draws", "draws", its<&R::draws>},
});

// Rows that count for a budget, worst first, with their values.
struct Row {
  std::size_t at = 0;  // in FrameLog::frames()
  double value = 0;
};
struct Ranked {
  std::string field, unit;
  std::vector<Row> rows;
  std::size_t next = 0;
};

// The value of row i of a log.
struct Column {
  std::string unit;
  bool time = false;  // excluded frames do not count
  std::function<double(std::size_t)> of;
};

// Rows in which a budget can be missed.
struct Part {
  std::size_t first, end;
};

Ranked ranked(const Budget& budget, const Column& column, const FrameLog& log, const Part& part) {
  Ranked result{budget.field, column.unit, {}};
  const bool small_is_bad = budget.relation == Relation::kAtLeast;
  for (std::size_t i = part.first; i < part.end; ++i) {
    const FrameRecord& frame = log.frames()[i];
    const double value = column.of(i);
    if (std::isnan(value)) continue;
    if (column.time && frame.apart != telemetry::Apart::kNo) continue;
    if (value == 0 && !small_is_bad) continue;  // the frame has no defect
    result.rows.push_back({i, value});
  }
  std::ranges::stable_sort(result.rows, [&](const Row& a, const Row& b) {
    return small_is_bad ? a.value < b.value : a.value > b.value;
  });
  return result;
}

// Returns the column of a field; nothing if it has no value per frame.
std::optional<Column> column_of(std::string_view field, const FrameLog& log) {
  const auto measure = std::ranges::find_if(
      kMeasures, [&](const Measure& m) { return field.starts_with(m.prefix); });
  if (measure != kMeasures.end())
    return Column{std::string(measure->unit), measure->time,
                  [&log, measure](std::size_t i) { return measure->of(log.frames()[i]); }};
  for (std::size_t s = 0; s < log.systems().size(); ++s)
    if (field.starts_with(std::string(kSystemPrefix) + log.systems()[s] + "."))
      return Column{"ms", true, [&log, s](std::size_t i) { return double{log.system_ms(i)[s]}; }};
  for (std::size_t p = 0; p < log.passes().size(); ++p)
    if (field.starts_with(std::string(kPassPrefix) + log.passes()[p] + "."))
      return Column{"ms", true, [&log, p](std::size_t i) { return double{log.pass_ms(i)[p]}; }};
  for (std::size_t f = 0; f < log.figures().size(); ++f) {
    const telemetry::FigureInfo& figure = log.figures()[f];
    if (field.starts_with(std::string(kFigurePrefix) + figure.name + "."))
      return Column{figure.unit, figure.kind == telemetry::FigureKind::kDuration,
                    [&log, f](std::size_t i) { return log.own(i)[f]; }};
  }
  return std::nullopt;
}

// The frames after the warm-up, of the budget's section if it has one.
Part part_of(const Budget& budget, const FrameLog& log, double warmup_s,
             std::span<const telemetry::SectionRange> sections) {
  const std::size_t all = log.frames().size(), warm = all - log.frames_since(warmup_s).size();
  const auto name = section_field(budget.field, sections).section;
  const auto section = std::ranges::find(sections, name, &telemetry::SectionRange::name);
  if (section == sections.end()) return {warm, all};
  const auto [first, end] = find_section(log, *section).value.value_or(std::pair{warm, warm});
  return {std::max(first, warm), std::max(end, warm)};
}

// Returns the next row that is far enough from the chosen frames.
const Row* next_of(Ranked& ranked, const FrameLog& log, std::span<const WorstFrame> chosen) {
  while (ranked.next < ranked.rows.size()) {
    const Row& row = ranked.rows[ranked.next++];
    const double time_s = log.frames()[row.at].time_s;
    const auto near = [&](const WorstFrame& f) {
      return std::abs(f.time_s - time_s) < kApartSeconds;
    };
    if (std::ranges::none_of(chosen, near)) return &row;
  }
  return nullptr;
}

}  // namespace

std::vector<WorstFrame> worst_frames(std::span<const BudgetResult> budgets, const FrameLog& log,
                                     double warmup_s, std::size_t count,
                                     std::span<const telemetry::SectionRange> sections) {
  std::vector<Ranked> all;
  for (const BudgetResult& result : budgets) {
    if (result.holds) continue;
    const Budget& budget = result.budget;
    const std::string_view inner = section_field(budget.field, sections).field;
    if (const auto column = column_of(inner.empty() ? budget.field : inner, log))
      all.push_back(ranked(budget, *column, log, part_of(budget, log, warmup_s, sections)));
  }
  std::vector<WorstFrame> chosen;
  for (bool any = true; any && chosen.size() < count;) {
    any = false;
    for (Ranked& each : all) {
      const Row* row = chosen.size() < count ? next_of(each, log, chosen) : nullptr;
      if (row == nullptr) continue;
      const FrameRecord& frame = log.frames()[row->at];
      chosen.push_back({frame.index, frame.time_s,
                        fmt::format("{}: {:.5g} {}", each.field, row->value, each.unit)});
      any = true;
    }
  }
  std::ranges::sort(chosen, {}, &WorstFrame::index);
  return chosen;
}

}  // namespace psygen::frametest
