// MangoHud and mangoapp. Their logs name no unit: 0.6 writes microseconds, later versions
// milliseconds. The clock tells whether each frame has a row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/captures/readers.hpp"

namespace psygen::captures {
namespace {

using Cells = std::vector<std::string_view>;

constexpr std::string_view kEveryFrame = "log with log_interval=0, which logs every frame";

// The rows of a log, in the units of the file.
struct Rows {
  std::size_t fps = 0;
  std::optional<std::size_t> time, elapsed;
  std::vector<double> times;
  std::size_t rows = 0, unmeasured = 0;
  std::size_t microseconds = 0;  // rows with fps × time nearer to 10⁶ than to 10³
  double sum_but_first = 0, longest = 0;
  double first_elapsed = 0, last_elapsed = 0;
};

core::Result<void> add(const Source& source, const Table& table, const Cells& cells,
                       std::size_t line, Rows& rows) {
  constexpr double kBetween = 31'623;
  if (rows.elapsed) {
    const auto elapsed = number_in(cells[*rows.elapsed], table.separator).value;
    if (!elapsed) return damaged(source, line, "elapsed: it is not a number");
    if (rows.rows > 0 && *elapsed < rows.last_elapsed)
      return damaged(source, line, "elapsed: the clock goes backwards");
    if (rows.rows == 0) rows.first_elapsed = *elapsed;
    rows.last_elapsed = *elapsed;
  }
  ++rows.rows;
  if (!rows.time) return {};
  const auto time = time_in(cells[*rows.time], table, source, line);
  if (!time) return tl::unexpected(time.error());
  if (!*time) return ++rows.unmeasured, core::Result<void>{};
  const double fps = number_in(cells[rows.fps], table.separator).value.value_or(0);
  if (fps * **time > kBetween) ++rows.microseconds;
  rows.times.push_back(**time);
  rows.longest = std::max(rows.longest, **time);
  if (rows.rows > 1) rows.sum_but_first += **time;
  return {};
}

// The mean step of the clock in ms; `elapsed_ms` is its unit.
double step_of(const Rows& rows, double elapsed_ms) {
  return rows.rows < 2 ? 0
                       : (rows.last_elapsed - rows.first_elapsed) * elapsed_ms /
                             static_cast<double>(rows.rows - 1);
}

// Checks that the times of all frames add up to the clock; `unit_ms` is the unit of the times.
core::Result<void> check_sum(const Source& source, const Rows& rows, double unit_ms) {
  constexpr double kNanosecondMs = 1e-6, kTolerance = 0.05;
  const double step_ms = step_of(rows, kNanosecondMs);
  if (step_ms <= 0 || rows.times.empty()) return {};
  const double span_ms = step_ms * static_cast<double>(rows.rows - 1);
  const double excess_ms = rows.sum_but_first * unit_ms - span_ms;
  if (std::abs(excess_ms) <= kTolerance * span_ms + rows.longest * unit_ms) return {};
  const double frame_ms = rows.sum_but_first * unit_ms / static_cast<double>(rows.rows - 1);
  if (excess_ms > 0)
    return refused(source, fmt::format("the times add up to {:.4g} s, but elapsed spans {:.4g} s: "
                                       "two programs logged into the file",
                                       (span_ms + excess_ms) / 1000, span_ms / 1000));
  return refused(source,
                 fmt::format("the log is sampled: frames of about {:.3g} ms, but rows {:.3g} ms "
                             "apart, so it has one frame in {:.0f}; {}",
                             frame_ms, step_ms, std::max(2.0, step_ms / frame_ms), kEveryFrame));
}

}  // namespace

Reading read_mango_hud(const Source& source, const Table& table, std::string_view version) {
  constexpr double kMicrosecondMs = 1e-3;
  Rows rows;
  rows.fps = table.find("fps").value_or(0);
  rows.time = table.find("frametime");
  rows.elapsed = table.find("elapsed");
  const std::size_t all = table.header.size();
  const auto cut = for_each_row(
      source, table, {.fewest = all, .most = all, .max_of_first = all},
      [&](const Cells& cells, std::size_t line) { return add(source, table, cells, line, rows); });
  if (!cut) return tl::unexpected(cut.error());
  if (!rows.time) {
    const double step_ms = step_of(rows, kMicrosecondMs);  // of versions before 0.6
    const std::string every = step_ms > 0 ? fmt::format(" every {:.3g} ms", step_ms) : "";
    return refused(source, fmt::format("the log has rates{}, no frame times; {}, and a version of "
                                       "MangoHud from 0.6 on",
                                       every, kEveryFrame));
  }
  const bool in_microseconds = 2 * rows.microseconds > rows.times.size();
  const double unit_ms = in_microseconds ? kMicrosecondMs : 1;
  if (auto ok = check_sum(source, rows, unit_ms); !ok) return tl::unexpected(ok.error());
  for (double& time : rows.times)
    time *= unit_ms;

  Collected result;
  result.cut = *cut;
  result.unmeasured = rows.unmeasured;
  const bool is_app =
      std::filesystem::path(source.name).filename().string().starts_with("mangoapp_");
  result.capture.tool = fmt::format("{} {}", is_app ? "mangoapp" : "MangoHud",
                                    !version.empty()  ? version
                                    : in_microseconds ? "0.6"
                                                      : "0.7 or later");
  result.capture.column = in_microseconds ? "frametime (µs)" : "frametime";
  result.capture.meaning = is_app ? Meaning::kDisplayed : Meaning::kPresents;
  result.capture.frame_ms = std::move(rows.times);
  return result;
}

}  // namespace psygen::captures
