#include "engine/telemetry/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/report_plot.hpp"
#include "engine/telemetry/report_style.hpp"
#include "engine/telemetry/units.hpp"

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

// Escaped text of a figure; a dash that tells the reason where it is missing.
template <class T, class Text>
std::string shown(const Measured<T>& measured, const Text& text) {
  if (measured.has_value()) return escaped(text(static_cast<double>(*measured)));
  return fmt::format("<span class=\"none\" title=\"{}\">–</span>", escaped(measured.reason));
}

std::string whole(double value) {
  return fmt::format("{:.0f}", value);
}
std::string ms(double value) {
  return three_digits(value) + " ms";
}
std::string percent(double value) {
  return three_digits(value) + " %";
}
std::string frames_per_second(double frame_ms) {
  return frame_ms > 0 ? three_digits(1000.0 / frame_ms) : std::string("–");
}

// `value` is HTML; the label and the detail are plain text.
std::string card(std::string_view state, std::string_view label, std::string_view value,
                 std::string_view unit, std::string_view detail) {
  return fmt::format(
      "<div class=\"card {}\"><span class=\"label\">{}</span><b>{} <small>{}</small></b>"
      "<span>{}</span></div>\n",
      state, escaped(label), value, escaped(unit), detail);
}

std::string cards(const Summary& s) {
  const bool no_hole = s.missing.frames.has_value() && *s.missing.frames == 0;
  const bool a_hole = s.missing.frames.has_value() && *s.missing.frames > 0;
  const bool a_hitch = s.hitches.has_value() && *s.hitches > 0;
  const bool over = s.cache.peak_bytes.has_value() && *s.cache.peak_bytes > s.cache.budget_bytes;
  std::string html = "<div class=\"cards\">\n";
  html += card("", "Median frame rate", shown(s.frame_ms.p50, frames_per_second), "frames/s",
               shown(s.frame_ms.p50, ms) + " per frame");
  html += card("", "99 % of frames within", shown(s.frame_ms.p99, three_digits), "ms",
               "slowest frame " + shown(s.frame_ms.max, ms));
  html += card(a_hitch ? "bad" : "", "Hitches", shown(s.hitches, whole), "",
               shown(s.stutter_percent, percent) + " of the time in stutter");
  html += card(no_hole  ? "good"
               : a_hole ? "bad"
                        : "",
               "Frames with a hole", shown(s.missing.frames, whole),
               fmt::format("of {}", s.run.measured_frames),
               "visible to drawn, p99: " + shown(s.missing.time_to_visible_ms.p99, ms));
  html += card(over ? "bad" : "", "Largest cache", shown(s.cache.peak_bytes, bytes_text), "",
               "of a budget of " + bytes_text(static_cast<double>(s.cache.budget_bytes)));
  html += card("", "Triangles made per second", shown(s.synthesis.triangles_per_second, count_text),
               "", "by a busy modeler; " + shown(s.synthesis.models, count_text) + " models");
  html += card("", "The whole world, triangles", shown(s.world.triangles, count_text), "",
               shown(s.world.bytes_paper, size_text) + " in the paper's format");
  html += card("", "Resident memory, peak", shown(s.memory.peak_rss_bytes, bytes_text), "",
               shown(s.draw.triangles_p50, count_text) + " triangles in the median frame");
  return html + "</div>\n";
}

Plot base_plot(const FrameLog& log, const Summary& s, std::span<const double> times) {
  Plot plot;
  plot.times_s = times;
  plot.warmup_s = log.frames().empty() ? 0 : s.run.warmup_seconds;
  return plot;
}

Plot frame_time_plot(const FrameLog& log, const Summary& s, Plot plot) {
  plot.title = "Frame time";
  plot.unit = "ms";
  plot.series = {{"frame", 1, column(log, [](const auto& r) { return r.frame_ms; })}};
  if (s.frame_ms.p50.has_value()) {
    plot.levels.push_back({"median " + ms(*s.frame_ms.p50), *s.frame_ms.p50, true});
  }
  if (!s.frame_ms.p99.has_value()) return plot;
  plot.levels.push_back({"p99 " + ms(*s.frame_ms.p99), *s.frame_ms.p99, false});
  // A few slow frames must not flatten the rest.
  const double limit = std::max(1.6 * *s.frame_ms.p99, 2.5 * *s.frame_ms.p50);
  const std::vector<double>& values = plot.series[0].values;
  const auto above =
      std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; });
  if (above == 0) return plot;
  plot.top = limit;
  plot.note = fmt::format("{} frame{} off the scale; the slowest took {}.", above,
                          above == 1 ? " is" : "s are",
                          ms(*std::max_element(values.begin(), values.end())));
  return plot;
}

Plot systems_plot(const FrameLog& log, const Summary&, Plot plot) {
  plot.title = "Where the frame goes: systems of the tick";
  plot.unit = "ms";
  plot.kind = PlotKind::kStacked;
  std::vector<double> rest = column(log, [](const auto& r) { return r.frame_ms; });
  for (std::size_t i = 0; i < log.systems().size(); ++i) {
    PlotSeries series{log.systems()[i], static_cast<int>((i + 2) % 8) + 1, {}};
    series.values = column(log, [i](const auto& r) { return r.system_ms[i]; });
    for (std::size_t k = 0; k < rest.size(); ++k)
      rest[k] -= series.values[k];
    plot.series.push_back(std::move(series));
  }
  for (double& value : rest)
    value = std::max(value, 0.0);
  // The axis follows nearly all frames, as in the plot above.
  std::vector<double> sorted = column(log, [](const auto& r) { return r.frame_ms; });
  std::sort(sorted.begin(), sorted.end());
  if (!sorted.empty()) plot.top = 1.25 * sorted[(sorted.size() - 1) * 99 / 100];
  plot.series.push_back({"waiting and the rest", 0, std::move(rest)});
  return plot;
}

Plot missing_plot(const FrameLog& log, const Summary& s, Plot plot) {
  plot.title = "Missing geometry: nodes in view that are not drawn as wanted";
  plot.unit = "nodes";
  plot.kind = PlotKind::kPeaks;
  plot.series = {{"too coarse", 4, column(log, [](const auto& r) { return r.coarse_nodes; })},
                 {"holes", 6, column(log, [](const auto& r) { return r.holes; })}};
  double largest = 0;
  for (const PlotSeries& series : plot.series) {
    for (const double value : series.values)
      largest = std::max(largest, value);
  }
  if (largest < 5) plot.top = 5;
  plot.note = largest == 0 ? std::string("Nothing was missing in any frame.")
                           : fmt::format("At most {} of the picture's pixels after the warm-up.",
                                         or_dash(s.missing.pixels_max_percent, percent));
  return plot;
}

Plot cache_plot(const FrameLog& log, const Summary& s, Plot plot) {
  plot.title = "Geometry cache";
  plot.unit = "MiB";
  plot.kind = PlotKind::kPeaks;
  plot.series = {{"cache", 3, column(log, [](const auto& r) {
                    return static_cast<double>(r.cache_bytes) / kMebibyte;
                  })}};
  const auto budget = static_cast<double>(s.cache.budget_bytes);
  if (budget > 0) plot.levels = {{"budget " + bytes_text(budget), budget / kMebibyte, false}};
  if (budget > 0 && !plot.series[0].values.empty()) {
    const auto& values = plot.series[0].values;
    plot.top = 1.15 * std::max(budget / kMebibyte, *std::max_element(values.begin(), values.end()));
  }
  return plot;
}

// Synthesised triangles per second, in windows of a quarter of a second or a hundredth of the run.
Plot synthesis_plot(const FrameLog& log, const Summary&, Plot plot) {
  plot.title = "Synthesis: triangles made per second, all modelers";
  plot.unit = "million/s";
  plot.kind = PlotKind::kPeaks;
  std::vector<double> rates(log.frames().size(), 0.0);
  const auto frames = log.frames();
  const double window =
      frames.empty() ? 1.0 : std::max(0.25, (frames.back().time_s - frames[0].time_s) / 100.0);
  for (std::size_t first = 0; first < frames.size();) {
    std::size_t end = first;
    double triangles = 0;
    for (; end < frames.size() && frames[end].time_s < frames[first].time_s + window; ++end)
      triangles += static_cast<double>(frames[end].triangles_synthesised);
    end = std::max(end, first + 1);
    std::fill(rates.begin() + static_cast<std::ptrdiff_t>(first),
              rates.begin() + static_cast<std::ptrdiff_t>(end), triangles / window * 1e-6);
    first = end;
  }
  plot.series = {{"synthesis", 5, std::move(rates)}};
  return plot;
}

std::string plots(const FrameLog& log, const Summary& s) {
  if (log.frames().empty()) return "<p>No frame was drawn.</p>\n";
  const std::vector<double> times = column(log, [](const auto& r) { return r.time_s; });
  const Plot base = base_plot(log, s, times);
  return plot_html(frame_time_plot(log, s, base)) + plot_html(missing_plot(log, s, base)) +
         plot_html(cache_plot(log, s, base)) + plot_html(synthesis_plot(log, s, base)) +
         plot_html(systems_plot(log, s, base));
}

// A titled table of labels (plain) and values (HTML).
class Facts {
 public:
  explicit Facts(std::string_view title)
      : html_(fmt::format("<section><h2>{}</h2><table>", escaped(title))) {}
  void add(std::string_view label, std::string_view html) {
    fmt::format_to(std::back_inserter(html_), "<tr><th>{}</th><td>{}</td></tr>", escaped(label),
                   html);
  }
  std::string end() { return std::move(html_) + "</table></section>\n"; }

 private:
  std::string html_;
};

std::string world_facts(const Summary& s) {
  Facts facts("World");
  const bool endless = s.world.blocks[0] == 0 || s.world.blocks[1] == 0;
  facts.add("name", escaped(s.world.name));
  facts.add("seed", std::to_string(s.world.seed));
  facts.add("blocks", endless ? std::string("endless")
                              : fmt::format("{} × {}", s.world.blocks[0], s.world.blocks[1]));
  facts.add("triangles", shown(s.world.triangles, count_text));
  facts.add("size", shown(s.world.bytes, size_text));
  facts.add("paper's format", shown(s.world.bytes_paper, size_text));
  facts.add("hash",
            shown(s.hash.world, [&](double) { return fmt::format("{:016x}", *s.hash.world); }));
  return facts.end();
}

std::string run_facts(const Summary& s) {
  Facts facts("Run and device");
  facts.add("paradigm", escaped(s.run.paradigm));
  facts.add("policy", escaped(s.run.policy));
  facts.add("modelers", std::to_string(s.run.modelers));
  facts.add("picture", fmt::format("{} × {}", s.run.width, s.run.height));
  facts.add("levels of detail", s.run.lod ? "on" : "off");
  facts.add("fixed step",
            shown(s.run.fixed_step, [](double v) { return three_digits(v) + " Hz"; }));
  facts.add("length", fmt::format("{} frames, {} s", s.run.frames, three_digits(s.run.seconds)));
  facts.add("warm-up", three_digits(s.run.warmup_seconds) + " s");
  facts.add("device", escaped(s.device.name));
  facts.add("driver", escaped(s.device.driver));
  facts.add("Vulkan", escaped(s.device.api));
  return facts.end();
}

std::string frame_facts(const Summary& s) {
  Facts facts("Frames");
  facts.add("mean", shown(s.frame_ms.mean, ms));
  facts.add("p50", shown(s.frame_ms.p50, ms));
  facts.add("p95", shown(s.frame_ms.p95, ms));
  facts.add("p99", shown(s.frame_ms.p99, ms));
  facts.add("p99.9", shown(s.frame_ms.p999, ms));
  facts.add("slowest", shown(s.frame_ms.max, ms));
  facts.add("lowest 1 %", shown(s.low1_fps, three_digits) + " frames/s");
  facts.add("triangles, median", shown(s.draw.triangles_p50, count_text));
  facts.add("draws, median", shown(s.draw.draws_p50, whole));
  facts.add("frame ÷ floor", shown(s.draw.floor_ratio, three_digits));
  return facts.end();
}

std::string system_facts(const Summary& s) {
  Facts facts("Systems, p50 and p99");
  for (const SystemTimes& system : s.system_ms)
    facts.add(system.name, shown(system.p50, three_digits) + " / " + shown(system.p99, ms));
  return facts.end();
}

std::string streaming_facts(const Summary& s) {
  Facts cache("Cache");
  cache.add("budget", bytes_text(static_cast<double>(s.cache.budget_bytes)));
  cache.add("peak", shown(s.cache.peak_bytes, bytes_text));
  cache.add("hits", shown(s.cache.hits, count_text));
  cache.add("misses", shown(s.cache.misses, count_text));
  cache.add("evictions", shown(s.cache.evictions, count_text));
  cache.add("regenerations", shown(s.cache.regenerations, count_text));
  cache.add("prefetched and seen", shown(s.cache.prefetch_hit_percent, percent));
  Facts synthesis("Synthesis and missing geometry");
  synthesis.add("models", shown(s.synthesis.models, count_text));
  synthesis.add("triangles", shown(s.synthesis.triangles, count_text));
  synthesis.add("bytes", shown(s.synthesis.bytes, bytes_text));
  synthesis.add("busy time", shown(s.synthesis.seconds, three_digits) + " s");
  synthesis.add("cost error, p50", shown(s.synthesis.cost_error_percent.p50, percent));
  synthesis.add("cost error, p95", shown(s.synthesis.cost_error_percent.p95, percent));
  synthesis.add("missing nodes, p99", shown(s.missing.nodes_p99, whole));
  synthesis.add("missing pixels, worst", shown(s.missing.pixels_max_percent, percent));
  synthesis.add("visible to drawn, p50", shown(s.missing.time_to_visible_ms.p50, ms));
  return cache.end() + synthesis.end();
}

}  // namespace

std::string report_html(const FrameLog& log, const Summary& s) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">";
  html += "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  html += fmt::format("<title>psygen: flight through {}</title>", escaped(s.world.name));
  html += fmt::format("<style>{}</style></head><body><main>\n", report_style());
  html += fmt::format(
      "<h1>Flight through {}</h1>\n<p class=\"lead\">{} frames in {} s at {} × {} on "
      "{}</p>\n",
      escaped(s.world.name), s.run.frames, three_digits(s.run.seconds), s.run.width, s.run.height,
      escaped(s.device.name));
  html += cards(s) + plots(log, s);
  html += "<div class=\"facts\">\n" + frame_facts(s) + world_facts(s) + run_facts(s) +
          streaming_facts(s) + system_facts(s) + "</div>\n</main>";
  html += fmt::format("<script>{}</script></body></html>\n", report_script());
  return html;
}

core::Result<void> write_report_html(const std::filesystem::path& path, const FrameLog& log,
                                     const Summary& summary) {
  return write_text_file(path, report_html(log, summary));
}

}  // namespace psygen::telemetry
