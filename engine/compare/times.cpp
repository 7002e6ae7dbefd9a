#include "engine/compare/times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/utf8.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::compare {
namespace {

namespace fs = std::filesystem;
using captures::Capture;
using telemetry::Figure;

constexpr double kMinDeviations = 1.5;  // a change must exceed this many deviations

// A psygen run as a capture.
Capture capture_of(const RecordedRun& run) {
  Capture capture;
  capture.name = run.folder;
  capture.tool = "psygen";
  capture.column = "frame_ms";
  capture.meaning = captures::Meaning::kGameThread;
  for (std::size_t i = 0; i < run.frame_ms.size(); ++i)
    if (!run.left_out[i]) capture.frame_ms.push_back(run.frame_ms[i]);
  if (const std::size_t left_out = run.frame_ms.size() - capture.frame_ms.size(); left_out > 0)
    capture.notes.push_back(fmt::format("left out: excluded frames: {}", left_out));
  return capture;
}

bool may_be_capture(const fs::path& file) {
  const std::string ending = core::lower_ascii(file.extension().string());
  return ending == ".csv" || ending == ".json";
}

// Files of a folder that may be captures, and folders of psygen's runs, sorted.
std::vector<fs::path> candidates_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> found;
  if (fs::exists(folder / "frames.csv", error)) return {folder};
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code ignored;
    if (it->is_directory(ignored) && fs::exists(it->path() / "frames.csv", ignored)) {
      found.push_back(it->path());
      it.disable_recursion_pending();
    } else if (it->is_regular_file(ignored) && may_be_capture(it->path())) {
      found.push_back(it->path());
    }
  }
  std::ranges::sort(found);
  return found;
}

// Adds a capture, or a sentence about a file without frame times.
core::Result<void> add_file(const fs::path& file, TimesSide& side) {
  auto capture = captures::read(file);
  if (capture) {
    side.captures.push_back(std::move(*capture));
  } else if (capture.error().code == core::ErrorCode::kInvalidArgument) {
    side.skipped.push_back(capture.error().message);
  } else {
    return tl::unexpected(capture.error());
  }
  return {};
}

// The value of a figure for each capture of a side; empty if some capture has none.
std::vector<double> values_of(std::span<const Capture> side, Figure (*figure)(const Capture&)) {
  std::vector<double> values;
  for (const Capture& capture : side)
    if (const Figure value = figure(capture); value.has_value()) values.push_back(*value);
  if (values.size() != side.size()) values.clear();
  return values;
}

template <int kPercent>
Figure percentile_of(const Capture& capture) {
  return telemetry::percentile(capture.frame_ms, kPercent / 100.0);
}

// How a figure is computed. Only figures that gate take part in the verdict.
struct Rule {
  std::string_view name, unit;
  Figure (*figure)(const Capture&);
  bool gates;
  double worse;  // 1 if larger is worse, else −1
};
constexpr std::array<Rule, 6> kRules = {{
    {"mean", "ms", [](const Capture& c) { return telemetry::mean(c.frame_ms); }, true, 1},
    {"p50", "ms", percentile_of<50>, true, 1},
    {"p95", "ms", percentile_of<95>, false, 1},
    {"p99", "ms", percentile_of<99>, true, 1},
    {"1 % low", "fps", [](const Capture& c) { return telemetry::low1_fps(c.frame_ms); }, false, -1},
    {"hitches", "",
     [](const Capture& c) -> Figure {
       const auto count = telemetry::hitches(c.frame_ms);
       return count.has_value() ? Figure(static_cast<double>(*count)) : Figure();
     },
     false, 1},
}};

// The step that 95 of 100 comparisons find, in deviations of a run: measured for 5 captures on one
// side and this many on the other.
double deviations_seen(std::size_t captures) {
  return captures >= 35 ? 2.7 : captures >= 20 ? 2.9 : captures >= 10 ? 3.1 : 4.0;
}

// Judges logarithms of the values: Mann-Whitney, a floor, and the spread.
void judge(const std::vector<double>& a, const std::vector<double>& b, const Rule& rule,
           TimesFigure& figure) {
  std::vector<double> log_a = a, log_b = b, residuals;
  for (auto* logs : {&log_a, &log_b}) {
    for (double& value : *logs)
      value = std::log(value);
    const double middle = median(*logs);
    for (const double value : *logs)
      residuals.push_back(std::abs(value - middle));
  }
  const double spread = kRobust * median(residuals);
  const double change = median(log_b) - median(log_a);
  const double unseen = deviations_seen(std::max(a.size(), b.size())) * spread;
  figure.p = mann_whitney(a, b);
  figure.unseen_percent = 100 * std::expm1(std::max(unseen, std::log(kTimesFloor)));
  const bool is_change = std::abs(change) >= std::log(kTimesFloor);
  if (is_change && *figure.p <= kSignificant && std::abs(change) >= kMinDeviations * spread) {
    figure.verdict = rule.worse * change > 0 ? Verdict::kWorse : Verdict::kBetter;
  } else if (!is_change && unseen <= std::log(kTimesWanted)) {
    figure.verdict = Verdict::kSame;
  }
}

TimesFigure figure_of(const Rule& rule, std::span<const Capture> a, std::span<const Capture> b) {
  TimesFigure figure{.name = rule.name,
                     .unit = rule.unit,
                     .gates = rule.gates,
                     .a = {},
                     .b = {},
                     .ratio = {},
                     .p = {},
                     .unseen_percent = {}};
  const std::vector<double> of_a = values_of(a, rule.figure), of_b = values_of(b, rule.figure);
  if (!of_a.empty()) figure.a = median(of_a);
  if (!of_b.empty()) figure.b = median(of_b);
  if (figure.a && figure.b && *figure.a > 0) figure.ratio = *figure.b / *figure.a;
  if (rule.gates && std::min(of_a.size(), of_b.size()) >= kFewestCaptures)
    judge(of_a, of_b, rule, figure);
  return figure;
}

// The first capture of a side whose time column differs from the first of the other.
void warn_of_meanings(TimesComparison& comparison) {
  const Capture& first = comparison.a.captures.front();
  for (const auto* side : {&comparison.a, &comparison.b}) {
    for (const Capture& other : side->captures) {
      if (other.meaning == first.meaning) continue;
      comparison.warnings.push_back(fmt::format(
          "{} of {} ({}) and {} of {} ({}) are different intervals: compare them with care",
          first.column, first.name, captures::phrase_of(first.meaning), other.column, other.name,
          captures::phrase_of(other.meaning)));
      return;
    }
  }
}

void conclude(TimesComparison& comparison) {
  const std::size_t a = comparison.a.captures.size(), b = comparison.b.captures.size();
  if (std::min(a, b) < kFewestCaptures) {
    comparison.reasons.push_back(
        fmt::format("A has {} capture{} and B has {}: a verdict needs {} or more of each side", a,
                    a == 1 ? "" : "s", b, kFewestCaptures));
    return;
  }
  bool all_same = true;
  for (const TimesFigure& figure : comparison.figures) {
    if (!figure.gates) continue;
    if (!figure.p) {
      comparison.reasons.push_back(
          fmt::format("{}: some captures have too few frames, so it is not judged", figure.name));
      continue;
    }
    all_same = all_same && figure.verdict == Verdict::kSame;
    if (figure.verdict == Verdict::kWorse || figure.verdict == Verdict::kBetter) {
      comparison.reasons.push_back(fmt::format("{} takes {:.1f} % {} (p {:.4f})", figure.name,
                                               100 * std::abs(*figure.ratio - 1),
                                               *figure.ratio > 1 ? "more" : "less", *figure.p));
      if (comparison.verdict != Verdict::kWorse) comparison.verdict = figure.verdict;
    } else if (figure.verdict == Verdict::kInconclusive) {
      comparison.reasons.push_back(
          fmt::format("{}: changes below {:.0f} % would stay unseen (p "
                      "{:.4f})",
                      figure.name, *figure.unseen_percent, *figure.p));
    }
  }
  if (comparison.verdict == Verdict::kInconclusive && all_same) comparison.verdict = Verdict::kSame;
  comparison.reasons.emplace_back(
      "captures carry no reference load, so another state of the machine looks like another game");
}

}  // namespace

bool holds_captures(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return true;
  bool has_run = false, has_file = false;
  for (const fs::path& each : candidates_in(path)) {
    if (fs::is_directory(each, error)) {
      has_run = true;
      continue;
    }
    has_file = true;
    if (captures::read(each)) return true;
  }
  return has_file && !has_run;
}

core::Result<TimesSide> read_times(const fs::path& path) {
  TimesSide side;
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    auto capture = captures::read(path);
    if (!capture) return tl::unexpected(capture.error());
    side.captures.push_back(std::move(*capture));
    return side;
  }
  for (const fs::path& each : candidates_in(path)) {
    if (!fs::is_directory(each, error)) {
      if (auto ok = add_file(each, side); !ok) return tl::unexpected(ok.error());
      continue;
    }
    const auto run = read_run(each);
    if (!run) return tl::unexpected(run.error());
    if (run->virtual_clock)
      return core::invalid_argument(each.string() +
                                    ": its times are costs of the virtual clock; captures compare "
                                    "with runs on the wall clock");
    side.captures.push_back(capture_of(*run));
    if (side.captures.back().frame_ms.empty())
      return core::invalid_argument(each.string() + ": no frame counts after the warm-up");
  }
  if (!side.captures.empty()) return side;
  if (!side.skipped.empty()) return core::invalid_argument(side.skipped.front());
  return core::fail(core::ErrorCode::kIo,
                    path.string() + ": the folder has no run (frames.csv) and no capture");
}

core::Result<TimesComparison> compare_times(TimesSide a, TimesSide b) {
  for (const auto* side : {&a, &b})
    if (side->captures.size() > kMaxCaptures)
      return core::invalid_argument(fmt::format("a side has {} captures; at most {} are compared",
                                                side->captures.size(), kMaxCaptures));
  TimesComparison comparison;
  for (const Rule& rule : kRules)
    comparison.figures.push_back(figure_of(rule, a.captures, b.captures));
  comparison.a = std::move(a);
  comparison.b = std::move(b);
  warn_of_meanings(comparison);
  conclude(comparison);
  return comparison;
}

}  // namespace psygen::compare
