#include "engine/telemetry/report_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "engine/telemetry/units.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

template <class Field>
std::vector<double> column(const FrameLog& log, const Field& field) {
  std::vector<double> values;
  values.reserve(log.frames().size());
  for (const FrameRecord& r : log.frames())
    values.push_back(static_cast<double>(field(r)));
  return values;
}

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// One value per timed frame; missing for excluded frames.
template <class Field>
std::vector<double> timed_column(const FrameLog& log, const Field& field) {
  return column(log, [&](const FrameRecord& r) {
    return r.apart == Apart::kNo ? static_cast<double>(field(r)) : kNothing;
  });
}

std::vector<double> system_column(const FrameLog& log, std::size_t system) {
  std::vector<double> ms;
  for (std::size_t frame = 0; frame < log.frames().size(); ++frame)
    ms.push_back(double{log.system_ms(frame)[system]});
  return ms;
}

std::vector<double> own_column(const FrameLog& log, std::size_t figure) {
  std::vector<double> values;
  for (std::size_t frame = 0; frame < log.frames().size(); ++frame)
    values.push_back(log.own(frame)[figure]);
  return values;
}

// The first of the game's figures have plots; all others are shown for single frames.
constexpr std::size_t kMaxOwnPlots = 16;

// Adds a note about the excluded frames.
void tell_apart(const FrameLog& log, const Summary& s, Plot& plot) {
  if (std::ranges::all_of(log.frames(), [](const auto& r) { return r.apart == Apart::kNo; }))
    return;
  const std::string text = left_out_text(s);
  plot.note = text.empty() ? "Marked frames belong to the warm-up." : text + " They are marked.";
}

Plot frame_time_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "Frame time", .unit = "ms"};
  plot.series = {{"frame", 1, timed_column(log, [](const auto& r) { return r.frame_ms; })}};
  if (s.gpu_ms.p50.has_value()) {
    plot.series.push_back(
        {"GPU", 2, timed_column(log, [](const auto& r) { return r.gpu_ms.value_or(kNothing); })});
  }
  tell_apart(log, s, plot);
  if (s.frame_ms.p50.has_value()) {
    plot.levels.push_back(
        {fmt::format("median {}", ms_text(*s.frame_ms.p50)), *s.frame_ms.p50, true});
  }
  if (!s.frame_ms.p99.has_value()) return plot;
  plot.levels.push_back({fmt::format("p99 {}", ms_text(*s.frame_ms.p99)), *s.frame_ms.p99, false});
  // A few slow frames must not flatten the others.
  const double limit = std::max(1.6 * *s.frame_ms.p99, 2.5 * *s.frame_ms.p50);
  double slowest = 0;
  std::size_t above = 0;
  for (const double ms : plot.series[0].values) {
    if (!std::isfinite(ms)) continue;
    slowest = std::max(slowest, ms);
    above += ms > limit ? 1 : 0;
  }
  if (above == 0) return plot;
  plot.top = limit;
  plot.note +=
      fmt::format("{}{} frame{} off the scale; the slowest took {}.", plot.note.empty() ? "" : " ",
                  above, above == 1 ? " is" : "s are", ms_text(slowest));
  return plot;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [](double sum, double v) { return std::isfinite(v) ? sum + v : sum; });
}

// The slowest systems, and the sum of all others.
std::vector<PlotSeries> system_series(const FrameLog& log) {
  constexpr std::size_t kShown = 5;
  constexpr int kOthersColour = 8;
  std::vector<PlotSeries> all;
  for (std::size_t i = 0; i < log.systems().size(); ++i) {
    std::vector<double> ms = system_column(log, i);
    for (std::size_t frame = 0; frame < ms.size(); ++frame)
      if (log.frames()[frame].apart != Apart::kNo) ms[frame] = kNothing;
    all.push_back({log.systems()[i], 0, std::move(ms)});
  }
  std::ranges::stable_sort(all, std::greater{},
                           [](const PlotSeries& series) { return sum_of(series.values); });
  if (all.size() > kShown + 1) {
    PlotSeries others{"other systems", kOthersColour, std::move(all[kShown].values)};
    for (std::size_t i = kShown + 1; i < all.size(); ++i) {
      for (std::size_t k = 0; k < others.values.size(); ++k)
        others.values[k] += all[i].values[k];
    }
    all.resize(kShown);
    all.push_back(std::move(others));
  }
  constexpr std::array kColours{1, 3, 4, 5, 6, 2};
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].colour == 0) all[i].colour = kColours[i % kColours.size()];
  return all;
}

Plot systems_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "Parts of a frame: systems of the tick, and waiting",
            .unit = "ms",
            .kind = PlotKind::kStacked,
            .series = system_series(log)};
  std::vector<double> rest =
      timed_column(log, [](const auto& r) { return r.frame_ms - r.wait_ms(); });
  for (const PlotSeries& series : plot.series) {
    for (std::size_t k = 0; k < rest.size(); ++k)
      rest[k] -= series.values[k];
  }
  for (double& value : rest)
    value = std::isfinite(value) ? std::max(value, 0.0) : value;
  plot.series.push_back({"other (poses, plugins)", 7, std::move(rest)});
  plot.series.push_back({"waiting for the GPU", 0,
                         timed_column(log, [](const auto& r) { return r.device_wait_ms; })});
  const auto window_ms = [](const FrameRecord& r) { return r.acquire_ms + r.present_ms; };
  if (std::ranges::any_of(log.frames(), [&](const auto& r) { return window_ms(r) > 0; }))
    plot.series.push_back({"presenting, waiting for the window", 9, timed_column(log, window_ms)});
  if (log.frames().size() > 0 && std::isnan(log.frames().front().device_wait_ms))
    plot.note = "The virtual clock does not measure systems.";
  // The axis fits nearly all frames, as in the plot of frame time.
  if (s.frame_ms.p99.has_value()) plot.top = 1.25 * *s.frame_ms.p99;
  tell_apart(log, s, plot);
  return plot;
}

// Raises the axis of small values to `top`. Returns the largest value.
double keep_axis_above(double top, Plot& plot) {
  double largest = 0;
  for (const PlotSeries& series : plot.series)
    for (const double value : series.values)
      largest = std::max(largest, value);
  if (largest < top) plot.top = top;
  return largest;
}

Plot coarse_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "Missing or too coarse part of the image",
            .unit = "% of the image",
            .kind = PlotKind::kPeaks};
  plot.series = {
      {"drawn too coarse", 4, column(log, [](const auto& r) { return r.too_coarse_percent; })},
      {"missing, or more than one level too coarse (estimate)", 6,
       column(log, [](const auto& r) { return r.missing_pixels_percent; })}};
  plot.levels = {{fmt::format("{:g} %", kCoarsePercent), kCoarsePercent, false}};
  keep_axis_above(2, plot);
  if (s.run.measured_frames > 0) {
    plot.note =
        fmt::format("More than {:g} % in {} of {} frames after the warm-up.", kCoarsePercent,
                    value_or_dash(s.missing.coarse_frames, whole), s.run.measured_frames);
  }
  return plot;
}

Plot missing_plot(const FrameLog& log) {
  Plot plot{.title = "Missing geometry: nodes in view without the wanted mesh",
            .unit = "nodes",
            .kind = PlotKind::kPeaks};
  plot.series = {{"too coarse", 4, column(log, [](const auto& r) { return r.coarse_nodes; })},
                 {"holes", 6, column(log, [](const auto& r) { return r.holes; })}};
  if (keep_axis_above(5, plot) == 0) plot.note = "No frame had missing geometry.";
  return plot;
}

// Allowed error of LODs, which trades quality for frame time.
Plot error_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "Allowed screen-space error",
            .unit = "pixels",
            .note = "Allowed error of LODs. A larger error makes frames faster.",
            .series = {{"error", 5, column(log, [](const auto& r) { return r.error_pixels; })}},
            .small = true};
  if (s.run.error_pixels > 0)
    plot.levels = {{fmt::format("requested {:g}", s.run.error_pixels), s.run.error_pixels, true}};
  return plot;
}

// Render scale of the landscape.
Plot resolution_plot(const FrameLog& log) {
  return {
      .title = "Render scale of the landscape",
      .unit = "%",
      .note =
          "Lowered before geometric detail if frames take too long; the image is then upscaled.",
      .series = {{"resolution", 5, column(log, [](const auto& r) { return 100 * r.resolution; })}},
      .small = true};
}

Plot cache_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "Geometry cache", .unit = "MiB", .kind = PlotKind::kPeaks};
  plot.series = {{"cache", 3, column(log, [](const auto& r) {
                    return static_cast<double>(r.cache_bytes) / kMebibyte;
                  })}};
  const auto budget = static_cast<double>(s.cache.budget_bytes);
  if (budget > 0)
    plot.levels = {{fmt::format("budget {}", bytes_text(budget)), budget / kMebibyte, false}};
  if (budget > 0 && !plot.series[0].values.empty()) {
    const auto& values = plot.series[0].values;
    plot.top = 1.15 * std::max(budget / kMebibyte, *std::max_element(values.begin(), values.end()));
    plot.zooms = false;
  }
  return plot;
}

// One value for each window of a quarter of a second or a hundredth of the run. `value(frames)` is
// that of the window's frames, at least one.
template <class Value>
std::vector<double> by_window(const FrameLog& log, const Value& value) {
  const auto frames = log.frames();
  std::vector<double> values(frames.size(), 0.0);
  const double window =
      frames.empty() ? 1.0 : std::max(0.25, (frames.back().time_s - frames[0].time_s) / 100.0);
  for (std::size_t first = 0; first < frames.size();) {
    std::size_t end = first;
    while (end < frames.size() && frames[end].time_s < frames[first].time_s + window)
      ++end;
    end = std::max(end, first + 1);
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(first),
              values.begin() + static_cast<std::ptrdiff_t>(end),
              value(frames.subspan(first, end - first), window));
    first = end;
  }
  return values;
}

// In virtual time there is one modeler, which works by the flight's clock.
Plot modelers_plot(const FrameLog& log, const Summary& s) {
  const auto percent = [&](std::span<const FrameRecord> frames, double window_s) {
    const bool is_virtual = std::isnan(frames.front().main_cpu_ms);
    double busy_s = 0, real_s = 0;
    for (const FrameRecord& r : frames) {
      busy_s += r.synthesis_seconds;
      real_s += r.frame_ms * 1e-3;
    }
    const double all_s = is_virtual ? window_s : real_s * s.run.modelers;
    return all_s > 0 ? std::min(100 * busy_s / all_s, 100.0) : 0;
  };
  return {.title = "Modelers: load",
          .unit = "% of their time",
          .note =
              "Processor time of synthesis, relative to the capacity of all modelers. Far below "
              "100 % while geometry is missing: modelers got no processor.",
          .kind = PlotKind::kPeaks,
          .series = {{"busy", 7, by_window(log, percent)}},
          .top = 105,
          .zooms = false,
          .small = true};
}

Plot synthesis_plot(const FrameLog& log) {
  const auto millions = [](std::span<const FrameRecord> frames, double window_s) {
    double triangles = 0;
    for (const FrameRecord& r : frames)
      triangles += static_cast<double>(r.triangles_synthesised);
    return triangles / window_s * 1e-6;
  };
  return {.title = "Synthesis: triangles per second of the flight, all modelers",
          .unit = "million/s",
          .kind = PlotKind::kPeaks,
          .series = {{"synthesis", 3, by_window(log, millions)}},
          .small = true};
}

// Times between frames as the display gets them.
Plot presents_plot(const FrameLog& log) {
  Plot plot{.title = "Time between presents, and animation error (absolute)", .unit = "ms"};
  plot.series = {
      {"between presents", 1,
       timed_column(log, [](const auto& r) { return r.between_presents_ms.value_or(kNothing); })},
      {"animation error", 6, timed_column(log, [](const auto& r) {
         return std::abs(r.animation_error_ms.value_or(kNothing));
       })}};
  plot.small = true;
  return plot;
}

// GPU times of the passes.
Plot passes_plot(const FrameLog& log, const Summary& s) {
  Plot plot{.title = "GPU time of the passes", .unit = "ms", .kind = PlotKind::kStacked};
  for (std::size_t pass = 0; pass < log.passes().size(); ++pass) {
    std::vector<double> ms;
    for (std::size_t frame = 0; frame < log.frames().size(); ++frame)
      ms.push_back(double{log.pass_ms(frame)[pass]});
    plot.series.push_back({log.passes()[pass], 1 + static_cast<int>(pass % 8), std::move(ms)});
  }
  if (s.gpu_ms.p99.has_value()) plot.top = 1.25 * *s.gpu_ms.p99;
  return plot;
}

// A plot from 0: negative values of a figure are cut off, which the note tells.
Plot own_plot(const FrameLog& log, const Summary& s, std::size_t figure) {
  const OwnFigureTimes& times = s.figures[figure];
  Plot plot{
      .title = times.info.name,
      .unit = times.info.unit,
      .kind = times.info.kind == FigureKind::kGauge ? PlotKind::kLine : PlotKind::kPeaks,
      .series = {{times.info.name, 1 + static_cast<int>(figure % 8), own_column(log, figure)}},
      .small = true};
  const auto below = std::ranges::count_if(plot.series[0].values, [](double v) { return v < 0; });
  if (below > 0)
    plot.note = fmt::format("{} frames have values below 0, which the plot cuts off.", below);
  if (times.p99.has_value() && *times.p99 > 0)
    plot.levels = {{fmt::format("p99 {}", three_digits(*times.p99)), *times.p99, false}};
  return plot;
}

// Frames that the rows of the plots represent. If there are too many, each is the slowest of
// `every`.
struct ShownFrames {
  std::size_t every = 1;
  std::vector<std::size_t> frames;  // positions in the log, ascending
};

constexpr std::size_t kMaxRows = 20'000;

// Excluded frames come last.
double slowness(const FrameRecord& record) {
  return record.apart == Apart::kNo ? record.frame_ms : -1;
}

// Reduces values of all frames to those of the rows; a row of peaks has the largest value.
std::vector<double> thinned(std::vector<double> all, const ShownFrames& shown, bool peaks = false) {
  if (shown.every <= 1) return all;
  std::vector<double> values;
  for (std::size_t row = 0; row < shown.frames.size(); ++row) {
    values.push_back(all[shown.frames[row]]);
    const std::size_t end = std::min((row + 1) * shown.every, all.size());
    for (std::size_t k = row * shown.every; k < end && peaks; ++k)
      values.back() = std::fmax(values.back(), all[k]);
  }
  return values;
}

std::vector<RowFigure> figures(const FrameLog& log, const ShownFrames& shown) {
  std::vector<RowFigure> list;
  const auto add = [&](const char* name, const char* unit, const auto& field) {
    list.push_back({name, unit, thinned(column(log, field), shown)});
  };
  add("processor time of the main thread", "ms", [](const auto& r) { return r.main_cpu_ms; });
  add("device memory", "MiB", [](const auto& r) {
    return r.device_bytes ? static_cast<double>(*r.device_bytes) / kMebibyte : kNothing;
  });
  add("shadows on the GPU", "ms",
      [](const auto& r) { return r.gpu_shadows_ms.value_or(kNothing); });
  add("triangles", "", [](const auto& r) { return r.triangles; });
  add("draws", "", [](const auto& r) { return r.draws; });
  add("nodes in view", "", [](const auto& r) { return r.nodes_in_view; });
  add("models synthesised", "", [](const auto& r) { return r.models_synthesised; });
  add("requests queued", "", [](const auto& r) { return r.requests_queued; });
  add("requests rejected for lack of memory", "", [](const auto& r) { return r.requests_refused; });
  add("evicted from the cache", "", [](const auto& r) { return r.cache_evictions; });
  for (std::size_t i = kMaxOwnPlots; i < log.figures().size(); ++i)
    list.push_back(
        {log.figures()[i].name, log.figures()[i].unit, thinned(own_column(log, i), shown)});
  return list;
}

std::vector<RowFigure> parts(const FrameLog& log, const ShownFrames& shown) {
  std::vector<RowFigure> list;
  const auto add = [&](const std::string& name, std::vector<double> ms) {
    list.push_back({name, "ms", thinned(std::move(ms), shown)});
  };
  for (std::size_t i = 0; i < log.systems().size(); ++i)
    add(log.systems()[i], system_column(log, i));
  add("waiting for the GPU", column(log, [](const auto& r) { return r.device_wait_ms; }));
  add("presenting, waiting for the window",
      column(log, [](const auto& r) { return r.acquire_ms + r.present_ms; }));
  return list;
}

ShownFrames shown_frames(const FrameLog& log) {
  const auto frames = log.frames();
  ShownFrames shown;
  shown.every = (frames.size() + kMaxRows - 1) / kMaxRows;
  for (std::size_t first = 0; first < frames.size(); first += shown.every) {
    const auto group = frames.subspan(first, std::min(shown.every, frames.size() - first));
    shown.frames.push_back(
        first +
        static_cast<std::size_t>(std::ranges::max_element(group, {}, slowness) - group.begin()));
  }
  return shown;
}

// Data of the rows besides the plots.
PageRows page_rows(const FrameLog& log, const Summary& summary, const ShownFrames& shown) {
  PageRows rows;
  rows.every = std::max<std::size_t>(shown.every, 1);
  rows.times_s = thinned(column(log, [](const auto& r) { return r.time_s; }), shown);
  rows.numbers = thinned(column(log, [](const auto& r) { return r.index; }), shown);
  rows.warmup_s = summary.run.warmup_seconds;
  rows.figures = figures(log, shown);
  rows.parts = parts(log, shown);
  for (std::size_t row = 0; row < shown.frames.size(); ++row) {
    const FrameRecord& record = log.frames()[shown.frames[row]];
    if (record.apart != Apart::kNo) rows.apart[row] = name_of(record.apart);
    if (record.has_picture) rows.pictures[row] = picture_name(record.index);
  }
  for (const FrameMark& mark : log.marks()) {
    std::string& names = rows.marks[mark.row / rows.every];
    names += (names.empty() ? "" : ", ") + mark.name;
  }
  return rows;
}

}  // namespace

std::string report_plots(const FrameLog& log, const Summary& s) {
  if (log.frames().empty()) return "<p>No frame was drawn.</p>\n";
  const ShownFrames shown = shown_frames(log);
  std::string html = page_tools_html(page_rows(log, s, shown));
  const auto add = [&](Plot plot) {
    for (PlotSeries& series : plot.series)
      series.values = thinned(std::move(series.values), shown, plot.kind == PlotKind::kPeaks);
    html += plot_html(plot);
  };
  add(frame_time_plot(log, s));
  add(error_plot(log, s));
  if (s.detail.resolution_min.value.value_or(1) < 1) add(resolution_plot(log));
  if (s.between_presents_ms.p50.has_value()) add(presents_plot(log));
  html += distribution_html();
  add(systems_plot(log, s));
  const auto measured = [](const PassTimes& pass) { return pass.p50.has_value(); };
  if (std::ranges::any_of(s.pass_ms, measured)) add(passes_plot(log, s));
  add(coarse_plot(log, s));
  add(missing_plot(log));
  add(cache_plot(log, s));
  add(modelers_plot(log, s));
  add(synthesis_plot(log));
  for (std::size_t i = 0; i < std::min(log.figures().size(), kMaxOwnPlots); ++i)
    add(own_plot(log, s, i));
  return html;
}

}  // namespace psygen::telemetry
