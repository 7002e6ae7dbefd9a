#include <fmt/format.h>

#include <iterator>

#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {
namespace {

std::string share(double value) {
  return percent_text(100 * value);
}

// Lines of a title, a label and a text; long texts continue on the next line.
class Table {
 public:
  void section(std::string_view title) { title_ = title; }
  void row(std::string_view label, std::string_view text) {
    while (text.size() > kColumns) {
      std::size_t end = text.rfind(' ', kColumns);
      if (end == std::string_view::npos) end = text.find(' ');
      if (end == std::string_view::npos) break;
      line(label, text.substr(0, end));
      label = "";
      text.remove_prefix(end + 1);
    }
    line(label, text);
  }
  std::string take() { return std::move(text_); }

 private:
  static constexpr std::size_t kColumns = 48;  // for the text; 78 in total

  void line(std::string_view label, std::string_view text) {
    fmt::format_to(std::back_inserter(text_), "{:<10} {:<18} {}\n", title_, label, text);
    title_ = "";
  }

  std::string text_;
  std::string_view title_;
};

// "p50 1.2 ms, p99 3.4 ms"; the second percentile has another name on request.
template <class Text>
std::string spread_text(const Figure& p50, const Figure& high, const Text& text,
                        std::string_view name = "p99") {
  return fmt::format("p50 {}, {} {}", value_or_dash(p50, text), name, value_or_dash(high, text));
}

std::string blocks_text(const WorldFacts& world) {
  if (world.endless()) return "endless";
  return fmt::format("{} x {} blocks", world.blocks[0], world.blocks[1]);
}

void add_world(Table& table, const WorldFacts& world) {
  table.section("world");
  table.row("name", fmt::format("{}, seed {}, {}", world.name, world.seed, blocks_text(world)));
  if (world.triangles.has_value() || world.block_m <= 0) {
    table.row("if generated", fmt::format("{} triangles, {} ({} in the paper's format)",
                                          value_or_dash(world.triangles, count_text),
                                          value_or_dash(world.bytes, size_text),
                                          value_or_dash(world.bytes_paper, size_text)));
  } else {
    const double triangles = world.per_km2(world.block_triangles);
    table.row("if generated",
              fmt::format("{} triangles, {} per square kilometre, endless", count_text(triangles),
                          size_text(world.per_km2(world.block_bytes))));
  }
}

void add_run(Table& table, const Summary& s) {
  add_world(table, s.world);
  table.section("run");
  table.row("device", s.device.name);
  table.row("options", fmt::format("{}, {}, {} modeler{}, {} x {}, LOD {}", s.run.paradigm,
                                   s.run.policy, s.run.modelers, s.run.modelers == 1 ? "" : "s",
                                   s.run.width, s.run.height, s.run.lod ? "on" : "off"));
  table.row("length",
            fmt::format("{} frame{} in {} s, {} measured after {:g} s of warm-up", s.run.frames,
                        s.run.frames == 1 ? "" : "s", three_digits(s.run.seconds),
                        s.run.measured_frames, s.run.warmup_seconds));
  if (s.run.timed_frames < s.run.measured_frames) table.row("excluded", left_out_text(s));
}

void add_picture(Table& table, const Summary& s) {
  const Verdict verdict = judge_quality(s);
  table.section("picture");
  table.row("verdict", verdict.headline);
  for (const std::string& reason : verdict.reasons)
    table.row("why", reason);
  for (const std::string& advice : verdict.advice)
    table.row("advice", advice);
}

void add_frames(Table& table, const Summary& s) {
  const auto fps = [](double ms) { return ms > 0 ? three_digits(1000.0 / ms) : std::string("–"); };
  table.section("frame");
  table.row("median", fmt::format("{} ({} frames/s)", value_or_dash(s.frame_ms.p50, ms_text),
                                  value_or_dash(s.frame_ms.p50, fps)));
  table.row("p95, p99, max", fmt::format("{}, {}, {}", value_or_dash(s.frame_ms.p95, ms_text),
                                         value_or_dash(s.frame_ms.p99, ms_text),
                                         value_or_dash(s.frame_ms.max, ms_text)));
  table.row("lowest 1 %, 0.1 %",
            fmt::format("{}, {} frames/s", value_or_dash(s.low1_fps, three_digits),
                        value_or_dash(s.low01_fps, three_digits)));
  table.row("hitches", fmt::format("{}, {} of the time in stutter", value_or_dash(s.hitches, whole),
                                   value_or_dash(s.stutter_percent, percent_text)));
  table.row("drawn (median)",
            fmt::format("{} triangles in {} draws", value_or_dash(s.draw.triangles_p50, count_text),
                        value_or_dash(s.draw.draws_p50, whole)));
  table.row("waiting", spread_text(s.wait_ms.all.p50, s.wait_ms.all.p99, ms_text));
  table.row("GPU time", spread_text(s.gpu_ms.p50, s.gpu_ms.p99, ms_text));
  const Distribution &between = s.between_presents_ms, &error = s.animation_error_ms;
  table.row("between presents", spread_text(between.p50, between.p99, ms_text));
  table.row("animation error", spread_text(error.p50, error.p99, ms_text));
  table.section("systems");
  for (const SystemTimes& system : s.system_ms)
    table.row(system.name, spread_text(system.p50, system.p99, ms_text));
}

// Figures of a run that measured a reference load, as ratios to it.
void add_reference(Table& table, const Summary& s) {
  const ReferenceRatios ratios = reference_ratios(s);
  if (!s.reference.arith.wall_s.has_value()) return;
  const auto seconds = [](double value) { return three_digits(value) + " s"; };
  table.section("reference");
  table.row("load", fmt::format("arithmetic {}, memory {}, all processors {}",
                                value_or_dash(s.reference.arith.wall_s, seconds),
                                value_or_dash(s.reference.stream.wall_s, seconds),
                                value_or_dash(s.reference.pair.wall_s, seconds)));
  table.row("ratios to it", fmt::format("processor time {}, frame p50 {}, p99 {}",
                                        value_or_dash(ratios.cpu, three_digits),
                                        value_or_dash(ratios.frame_p50, three_digits),
                                        value_or_dash(ratios.frame_p99, three_digits)));
}

// The game's figures, and the sections of the run.
void add_own(Table& table, const Summary& s) {
  table.section("figures");
  for (const OwnFigureTimes& each : s.figures) {
    const std::string text = spread_text(each.p50, each.p99, three_digits);
    table.row(each.info.name, each.info.unit.empty() ? text : text + " " + each.info.unit);
    if (each.invalid > 0) table.row("", fmt::format("{} values were not finite", each.invalid));
  }
  table.section("sections");
  for (const Section& section : s.sections) {
    const FrameTimes& ms = section.frames.frame_ms;
    table.row(section.range.name, section.missing.empty()
                                      ? "frame " + spread_text(ms.p50, ms.p99, ms_text)
                                      : section.missing);
  }
  if (s.ignored_marks > 0) table.row("ignored marks", std::to_string(s.ignored_marks));
}

void add_streaming(Table& table, const Summary& s) {
  const auto& wait = s.missing.time_to_visible_ms;
  add_picture(table, s);
  table.section("missing");
  table.row("frames with holes", value_or_dash(s.missing.frames, whole));
  table.row("pixels", fmt::format("p99 {}, worst {}",
                                  value_or_dash(s.missing.pixels_p99_percent, percent_text),
                                  value_or_dash(s.missing.pixels_max_percent, percent_text)));
  table.row("too coarse", fmt::format("p99 {}, worst {} of the image",
                                      value_or_dash(s.missing.coarse_p99_percent, percent_text),
                                      value_or_dash(s.missing.coarse_max_percent, percent_text)));
  table.row("time to visible", spread_text(wait.p50, wait.p99, ms_text));
  table.section("cache");
  table.row("peak", fmt::format("{} of {}", value_or_dash(s.cache.peak_bytes, bytes_text),
                                bytes_text(static_cast<double>(s.cache.budget_bytes))));
  table.row("hits, misses", fmt::format("{}, {}; {} evictions, {} regenerations",
                                        value_or_dash(s.cache.hits, count_text),
                                        value_or_dash(s.cache.misses, count_text),
                                        value_or_dash(s.cache.evictions, count_text),
                                        value_or_dash(s.cache.regenerations, count_text)));
  table.section("synthesis");
  table.row("made", fmt::format("{} models, {} triangles, {}",
                                value_or_dash(s.synthesis.models, count_text),
                                value_or_dash(s.synthesis.triangles, count_text),
                                value_or_dash(s.synthesis.bytes, bytes_text)));
  table.row("ever drawn", value_or_dash(s.synthesis.share_drawn, share) + " of all triangles");
  table.row("speed", value_or_dash(s.synthesis.triangles_per_second, count_text) +
                         " triangles per busy second");
  table.row("modelers busy", value_or_dash(s.synthesis.busy_percent, percent_text));
  const auto& error = s.synthesis.cost_error_percent;
  table.row("cost error", spread_text(error.p50, error.p95, percent_text, "p95"));
  table.section("memory");
  table.row("resident, peak", value_or_dash(s.memory.peak_rss_bytes, bytes_text));
  table.row("device, peak", value_or_dash(s.memory.device_peak_bytes, bytes_text));
  add_reference(table, s);
}

}  // namespace

std::string to_text(const Summary& summary) {
  Table table;
  add_run(table, summary);
  add_frames(table, summary);
  add_own(table, summary);
  add_streaming(table, summary);
  return table.take();
}

}  // namespace psygen::telemetry
