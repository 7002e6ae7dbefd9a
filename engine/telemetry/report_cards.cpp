// Boxes at the top of report.html. The image box is green only if the verdict finds no fault
// (verdict.hpp); other boxes are amber, red or neutral.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/telemetry/report_parts.hpp"
#include "engine/telemetry/verdict.hpp"

namespace psygen::telemetry {
namespace {

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

}  // namespace

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

}  // namespace psygen::telemetry
