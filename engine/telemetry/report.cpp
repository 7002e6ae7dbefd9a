#include "engine/telemetry/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "engine/telemetry/report_plots.hpp"
#include "engine/telemetry/units.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {
namespace {

// Escaped text of a number; for a missing one, a dash with the reason as its tooltip.
template <class T, class Text>
std::string shown(const Measured<T>& measured, const Text& text) {
  if (measured.has_value()) return escaped(text(static_cast<double>(*measured)));
  return fmt::format("<span class=\"none\" title=\"{}\">–</span>", escaped(measured.reason));
}

std::string frames_per_second(double frame_ms) {
  return frame_ms > 0 ? three_digits(1000.0 / frame_ms) : std::string("–");
}

std::string_view class_of(Grade grade) {
  constexpr std::array<std::string_view, 4> kClasses = {"", "good", "fair", "bad"};
  return kClasses[static_cast<std::size_t>(grade)];
}

// `value` and `detail` are HTML; the label and the unit are plain text.
std::string card(std::string_view state, std::string_view label, std::string_view value,
                 std::string_view unit, std::string_view detail) {
  return fmt::format(
      "<div class=\"card {}\"><span class=\"label\">{}</span><b>{} <small>{}</small></b>"
      "<span>{}</span></div>\n",
      state, escaped(label), value, escaped(unit), detail);
}

// Escapes text; command-line options do not break over two lines.
std::string sentence_html(const std::string& sentence) {
  std::string html;
  std::size_t done = 0;
  for (std::size_t at = sentence.find("--"); at != std::string::npos;
       at = sentence.find("--", done)) {
    const std::size_t end =
        std::min(sentence.find_first_not_of("-abcdefghijklmnopqrstuvwxyz", at), sentence.size());
    html += escaped(sentence.substr(done, at - done));
    html += fmt::format("<code>{}</code>", escaped(sentence.substr(at, end - at)));
    done = end;
  }
  return html + escaped(sentence.substr(done));
}

// Formats the verdict as sentences.
std::string verdict_html(const Verdict& verdict) {
  std::string html = fmt::format("<section class=\"verdict {}\"><b>Image: {}</b>\n",
                                 class_of(verdict.grade), escaped(verdict.headline));
  for (const std::string& reason : verdict.reasons)
    html += fmt::format("<p>{}</p>\n", sentence_html(reason));
  for (const std::string& advice : verdict.advice)
    html += fmt::format("<p class=\"advice\">{}</p>\n", sentence_html(advice));
  return html + "</section>\n";
}

std::string speed_cards(const Summary& s) {
  const bool a_hitch = s.hitches.value.value_or(0) > 0;
  constexpr double kMissed = 1.05;  // ratio to the requested frame time
  const bool missed = s.run.target_fps.has_value() && s.frame_ms.p50.has_value() &&
                      *s.frame_ms.p50 > kMissed * 1000.0 / *s.run.target_fps;
  const std::string wanted =
      s.run.target_fps.has_value() ? fmt::format("; {:g} wanted", *s.run.target_fps) : "";
  std::string html;
  html += card(missed ? "fair" : "", "Median frame rate", shown(s.frame_ms.p50, frames_per_second),
               "frames/s", shown(s.frame_ms.p50, ms_text) + " per frame" + escaped(wanted));
  html += card("", "99 % of frames within", shown(s.frame_ms.p99, three_digits), "ms",
               "slowest frame " + shown(s.frame_ms.max, ms_text));
  html += card(a_hitch ? "bad" : "", "Hitches", shown(s.hitches, whole), "",
               shown(s.stutter_percent, percent_text) + " of the time in stutter");
  html += card("", "Waiting, median frame", shown(s.wait_ms.all.p50, three_digits), "ms",
               shown(s.gpu_ms.p50, ms_text) + " of GPU time");
  return html;
}

std::string resolution_text(const Summary& s) {
  const Figure& least = s.detail.resolution_min;
  if (!least.has_value() || *least >= 1) return "";
  return fmt::format("; render scale {} %, {} % at worst",
                     shown(s.detail.resolution_p50, [](double v) { return three_digits(100 * v); }),
                     three_digits(100 * *least));
}

std::string picture_cards(const Summary& s, Grade grade) {
  const bool a_hole = s.missing.frames.value.value_or(0) > 0;
  const bool coarse = s.missing.coarse_frames.value.value_or(0) > 0;
  const std::string_view good = grade == Grade::kGood ? "good" : "";
  const std::string of = fmt::format("of {}", s.run.measured_frames);
  std::string html;
  html += card(a_hole ? "bad" : good, "Frames with a hole", shown(s.missing.frames, whole), of,
               "time to visible, p99: " + shown(s.missing.time_to_visible_ms.p99, ms_text));
  html += card(coarse && grade != Grade::kGood ? class_of(grade) : good, "Frames too coarse",
               shown(s.missing.coarse_frames, whole), of,
               "worst: " + shown(s.missing.coarse_max_percent, percent_text) + " of the image");
  html += card(s.detail.max_pixels.has_value() && *s.detail.max_pixels > 1.005 * s.run.error_pixels
                   ? "fair"
                   : good,
               "Error of LODs", shown(s.detail.p50_pixels, three_digits), "pixels",
               " maximum " + shown(s.detail.max_pixels, three_digits) + "; requested " +
                   fmt::format("{:g}", s.run.error_pixels) + resolution_text(s));
  return html;
}

std::string world_card(const Summary& s) {
  if (!s.world.endless() || s.world.block_m <= 0) {
    return card("", "Whole world, triangles", shown(s.world.triangles, count_text), "",
                shown(s.world.bytes_paper, size_text) + " in the paper's format");
  }
  return card("", "One square kilometre, triangles",
              count_text(s.world.per_km2(s.world.block_triangles)), "",
              size_text(s.world.per_km2(s.world.block_bytes)) + "; the world is endless");
}

// The boxes at the top, each with a headline number, and the verdict on the image. The image box is
// green only if the verdict finds no fault (verdict.hpp); other boxes are amber, red or neutral.
std::string report_cards(const Summary& s) {
  const Verdict verdict = judge_quality(s);
  const bool over = s.cache.peak_bytes.has_value() && *s.cache.peak_bytes > s.cache.budget_bytes;
  std::string html = verdict_html(verdict) + "<div class=\"cards\">\n";
  html += speed_cards(s) + picture_cards(s, verdict.grade);
  html += card(over ? "bad" : "", "Cache, peak", shown(s.cache.peak_bytes, bytes_text), "",
               "of a budget of " + bytes_text(static_cast<double>(s.cache.budget_bytes)));
  html += card("", "Triangles synthesised per second",
               shown(s.synthesis.triangles_per_second, count_text), "",
               "per busy modeler; " + shown(s.synthesis.models, count_text) + " models");
  html += world_card(s);
  html += card("", "Resident memory, peak", shown(s.memory.peak_rss_bytes, bytes_text), "",
               shown(s.draw.triangles_p50, count_text) + " triangles in the median frame");
  return html + "</div>\n";
}

// A titled table of labels (plain text) and values (HTML).
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
  facts.add("name", escaped(s.world.name));
  facts.add("seed", std::to_string(s.world.seed));
  facts.add("blocks", s.world.endless()
                          ? std::string("endless")
                          : fmt::format("{} × {}", s.world.blocks[0], s.world.blocks[1]));
  if (!s.world.endless()) {
    facts.add("triangles", shown(s.world.triangles, count_text));
    facts.add("size", shown(s.world.bytes, size_text));
    facts.add("paper's format", shown(s.world.bytes_paper, size_text));
  }
  if (s.world.block_m > 0) {
    facts.add("a block", fmt::format("{:g} m, {} models", s.world.block_m,
                                     three_digits(s.world.block_models)));
    facts.add("triangles per km²", count_text(s.world.per_km2(s.world.block_triangles)));
    facts.add("size per km²", size_text(s.world.per_km2(s.world.block_bytes)));
  }
  facts.add("hash",
            shown(s.hash.world, [&](double) { return fmt::format("{:016x}", *s.hash.world); }));
  return facts.end();
}

std::string run_facts(const Summary& s) {
  Facts facts("Run and device");
  if (!s.run.command.empty()) facts.add("command", "<code>" + escaped(s.run.command) + "</code>");
  facts.add("preset", escaped(s.run.preset));
  facts.add("view distance", s.run.view_distance_m > 0
                                 ? fmt::format("{:g} m", s.run.view_distance_m)
                                 : std::string("–"));
  facts.add("paradigm", escaped(s.run.paradigm));
  facts.add("policy", escaped(s.run.policy));
  facts.add("modelers", std::to_string(s.run.modelers));
  facts.add("picture", fmt::format("{} × {}", s.run.width, s.run.height));
  facts.add("levels of detail", s.run.lod ? "on" : "off");
  facts.add("fixed step",
            shown(s.run.fixed_step, [](double v) { return fmt::format("{:g} Hz", v); }));
  facts.add("requested error", fmt::format("{:g} pixels", s.run.error_pixels));
  facts.add("target frame rate",
            shown(s.run.target_fps, [](double v) { return fmt::format("{:g} frames/s", v); }));
  facts.add("length", fmt::format("{} frames, {} s", s.run.frames, three_digits(s.run.seconds)));
  facts.add("warm-up", fmt::format("{:g} s", s.run.warmup_seconds));
  facts.add("device", escaped(s.device.name));
  facts.add("driver", escaped(s.device.driver));
  facts.add("Vulkan", escaped(s.device.api));
  return facts.end();
}

std::string frame_facts(const Summary& s) {
  Facts facts("Frames");
  facts.add("mean", shown(s.frame_ms.mean, ms_text));
  facts.add("p50", shown(s.frame_ms.p50, ms_text));
  facts.add("p95", shown(s.frame_ms.p95, ms_text));
  facts.add("p99", shown(s.frame_ms.p99, ms_text));
  facts.add("p99.9", shown(s.frame_ms.p999, ms_text));
  facts.add("slowest", shown(s.frame_ms.max, ms_text));
  facts.add("lowest 1 %", shown(s.low1_fps, three_digits) + " frames/s");
  facts.add("lowest 0.1 %", shown(s.low01_fps, three_digits) + " frames/s");
  const auto both = [](const Distribution& d) {
    return shown(d.p50, three_digits) + " / " + shown(d.p99, ms_text);
  };
  facts.add("between presents, p50 and p99", both(s.between_presents_ms));
  facts.add("animation error, p50 and p99", both(s.animation_error_ms));
  facts.add("device memory, peak", shown(s.memory.device_peak_bytes, bytes_text));
  facts.add("timed", fmt::format("{} of {} frames", s.run.timed_frames, s.run.measured_frames));
  facts.add("triangles, median", shown(s.draw.triangles_p50, count_text));
  facts.add("draws, median", shown(s.draw.draws_p50, whole));
  facts.add("frame ÷ floor", shown(s.draw.floor_ratio, three_digits));
  if (const ReferenceRatios ratios = reference_ratios(s); s.reference.pair.wall_s.has_value()) {
    facts.add("processor time ÷ reference load", shown(ratios.cpu, three_digits));
    facts.add("p50 and p99 ÷ reference load",
              shown(ratios.frame_p50, three_digits) + ", " + shown(ratios.frame_p99, three_digits));
  }
  return facts.end();
}

std::string system_facts(const Summary& s) {
  Facts facts("Parts of a frame, p50 and p99");
  const auto both = [](const Figure& p50, const Figure& p99) {
    return shown(p50, three_digits) + " / " + shown(p99, ms_text);
  };
  for (const SystemTimes& system : s.system_ms)
    facts.add(system.name, both(system.p50, system.p99));
  facts.add("render: recording", both(s.record_ms.p50, s.record_ms.p99));
  facts.add("waiting for the GPU", both(s.wait_ms.device.p50, s.wait_ms.device.p99));
  facts.add("waiting for the window", both(s.wait_ms.acquire.p50, s.wait_ms.acquire.p99));
  facts.add("… presenting", both(s.wait_ms.present.p50, s.wait_ms.present.p99));
  facts.add("GPU", both(s.gpu_ms.p50, s.gpu_ms.p99));
  facts.add("… shadows, p50", shown(s.gpu_ms.shadows_p50, ms_text));
  for (const PassTimes& pass : s.pass_ms)
    if (pass.p50.has_value()) facts.add("… pass " + pass.name, both(pass.p50, pass.p99));
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
  cache.add("prefetched, then visible", shown(s.cache.prefetch_hit_percent, percent_text));
  Facts synthesis("Synthesis and missing geometry");
  synthesis.add("models", shown(s.synthesis.models, count_text));
  synthesis.add("triangles", shown(s.synthesis.triangles, count_text));
  synthesis.add("bytes", shown(s.synthesis.bytes, bytes_text));
  synthesis.add("failed", shown(s.synthesis.failed, whole));
  synthesis.add("busy time", shown(s.synthesis.seconds, three_digits) + " s");
  synthesis.add("modelers busy", shown(s.synthesis.busy_percent, percent_text));
  synthesis.add("cost error, p50", shown(s.synthesis.cost_error_percent.p50, percent_text));
  synthesis.add("cost error, p95", shown(s.synthesis.cost_error_percent.p95, percent_text));
  synthesis.add("missing nodes, p99", shown(s.missing.nodes_p99, whole));
  synthesis.add("too coarse, p99", shown(s.missing.coarse_p99_percent, percent_text));
  synthesis.add("missing pixels, worst", shown(s.missing.pixels_max_percent, percent_text));
  synthesis.add("time to visible, p50", shown(s.missing.time_to_visible_ms.p50, ms_text));
  return cache.end() + synthesis.end();
}

// The game's figures with their unit: p50 and p99.
std::string own_facts(const Summary& s) {
  if (s.figures.empty()) return "";
  Facts facts("Figures of the game, p50 and p99");
  for (const OwnFigureTimes& each : s.figures) {
    std::string text = fmt::format("{} / {} {}", shown(each.p50, three_digits),
                                   shown(each.p99, three_digits), escaped(each.info.unit));
    if (each.invalid > 0) text += fmt::format("; {} values were not finite", each.invalid);
    facts.add(each.info.name, text);
  }
  return facts.end();
}

// Marks with the time of their first frame, then sections.
std::string section_facts(const Summary& s) {
  if (s.marks.empty() && s.sections.empty() && s.ignored_marks == 0) return "";
  Facts facts("Marks and sections");
  for (const MarkFacts& mark : s.marks)
    facts.add(mark.name, fmt::format("{:.2f} s, {} time{}", mark.time_s, mark.count,
                                     mark.count == 1 ? "" : "s"));
  if (s.ignored_marks > 0) facts.add("ignored marks", std::to_string(s.ignored_marks));
  for (const Section& section : s.sections) {
    const Summary& part = section.frames;
    facts.add(
        fmt::format("section {}", section.range.name),
        section.missing.empty()
            ? fmt::format("{} to {} s, {} frames, p50 {}, p99 {}",
                          shown(section.start_s, three_digits), shown(section.end_s, three_digits),
                          part.run.measured_frames, shown(part.frame_ms.p50, ms_text),
                          shown(part.frame_ms.p99, ms_text))
            : escaped(section.missing));
  }
  return facts.end();
}

// Tables of all other numbers.
std::string report_facts(const Summary& s) {
  return "<div class=\"facts\">\n" + frame_facts(s) + world_facts(s) + run_facts(s) +
         streaming_facts(s) + system_facts(s) + own_facts(s) + section_facts(s) + "</div>\n";
}

}  // namespace

std::string report_html(const FrameLog& log, const Summary& s) {
  const std::string title = "Flight through " + s.world.name;
  std::string body =
      fmt::format("<h1>{}</h1>\n<p class=\"lead\">{} frame{} in {} s at {} × {} on {}</p>\n",
                  escaped(title), s.run.frames, s.run.frames == 1 ? "" : "s",
                  three_digits(s.run.seconds), s.run.width, s.run.height, escaped(s.device.name));
  if (!s.run.command.empty())
    body += fmt::format("<p class=\"command\"><code>{}</code></p>\n", escaped(s.run.command));
  body += report_cards(s) + report_plots(log, s) + report_facts(s);
  return page_html("psygen: flight through " + s.world.name, "", body,
                   log.frames().empty() ? "" : page_script());
}

}  // namespace psygen::telemetry
