#include "engine/compare/compare_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "engine/telemetry/page.hpp"
#include "engine/telemetry/units.hpp"

namespace psygen::compare {
namespace {

using Runs = std::span<const RecordedRun>;
using telemetry::escaped;
using telemetry::Plot;
using telemetry::PlotKind;
using telemetry::three_digits;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kColourA = 1, kColourB = 2;

// For each of `times`, the value of the nearest frame of `run`. Only on the virtual clock without a
// fixed step do frames of other runs have other times.
std::vector<double> at_times(const RecordedRun& run, const std::vector<double>& values,
                             const std::vector<double>& times) {
  if (run.time_s == times) return values;
  std::vector<double> taken;
  for (const double time : times) {
    auto next = std::ranges::lower_bound(run.time_s, time);
    if (next == run.time_s.end() ||
        (next != run.time_s.begin() && time - *std::prev(next) < *next - time))
      --next;
    taken.push_back(values[static_cast<std::size_t>(next - run.time_s.begin())]);
  }
  return taken;
}

// Over the runs of a set: the shortest time of each frame, except frames that a run excludes.
std::vector<double> min_times(Runs runs, const std::vector<double>& times,
                              const std::vector<bool>& left_out) {
  std::vector<double> least(times.size(), std::numeric_limits<double>::infinity());
  for (const RecordedRun& run : runs) {
    const std::vector<double> ms = at_times(run, run.frame_ms, times);
    for (std::size_t k = 0; k < least.size(); ++k)
      least[k] = left_out[k] ? kNothing : std::min(least[k], ms[k]);
  }
  return least;
}

std::vector<double> means(Runs runs, const std::vector<double>& times,
                          const std::vector<double> RecordedRun::*field) {
  std::vector<double> sums(times.size(), 0.0);
  for (const RecordedRun& run : runs)
    std::ranges::transform(sums, at_times(run, run.*field, times), sums.begin(), std::plus{});
  for (double& value : sums)
    value /= static_cast<double>(runs.size());
  return sums;
}

Plot overlay(const char* title, const char* unit, std::vector<double> a, std::vector<double> b,
             const char* note) {
  return {.title = title,
          .unit = unit,
          .note = note,
          .series = {{"A", kColourA, std::move(a)}, {"B", kColourB, std::move(b)}}};
}

std::string plots(Runs a, Runs b) {
  const std::vector<double>& times = a.front().time_s;
  const std::vector<bool> left_out = left_out_of(a, b);
  const std::vector<double> a_ms = min_times(a, times, left_out);
  const std::vector<double> b_ms = min_times(b, times, left_out);
  telemetry::PageRows rows;
  rows.times_s = times;
  rows.timed_series = 2;
  for (std::size_t k = 0; k < times.size(); ++k) {
    rows.numbers.push_back(static_cast<double>(k));
    if (left_out[k]) rows.apart[k] = "excluded from all runs";
  }
  Plot ratio{.title = "Frame time of B divided by frame time of A",
             .unit = "B / A",
             .series = {{"B / A", 5, std::vector<double>(times.size())}},
             .levels = {{"the same", 1, true}},
             .small = true};
  std::ranges::transform(b_ms, a_ms, ratio.series[0].values.begin(), std::divides{});
  Plot lacking =
      overlay("Missing or too coarse part of the image", "% of the image",
              means(a, times, &RecordedRun::lacking), means(b, times, &RecordedRun::lacking),
              "Means of all runs. Drawing less makes frames faster.");
  lacking.kind = PlotKind::kPeaks;
  Plot error = overlay("Screen-space error of LODs", "pixels", means(a, times, &RecordedRun::error),
                       means(b, times, &RecordedRun::error), "Means of all runs.");
  error.small = true;
  return telemetry::page_tools_html(rows) +
         telemetry::plot_html(
             overlay("Frame time, A and B", "ms", a_ms, b_ms,
                     "The shortest time of each frame over the runs of a side: its "
                     "work without the interference of other programs.")) +
         telemetry::plot_html(ratio) + telemetry::plot_html(lacking) + telemetry::plot_html(error) +
         telemetry::distribution_html();
}

// One row of the table of effects.
struct Effect {
  const char* name;
  std::string a, b, effect, chance;
};

std::vector<Effect> effects_of(const Batch& b, bool exact) {
  const auto p = [exact](double value) {
    return exact ? std::string("exact") : fmt::format("p {:.3f}", value);
  };
  const auto times = [](double ratio) { return fmt::format("× {:.3f}", ratio); };
  const auto change = [](double from, double to) { return fmt::format("{:+.3g}", to - from); };
  const std::string interval = exact ? times(b.minima.ratio)
                                     : fmt::format("× {:.3f} ({:.3f} to {:.3f})", b.minima.ratio,
                                                   b.minima.low, b.minima.high);
  std::vector<Effect> effects = {
      {"frame time", "", "", interval, p(std::min(b.minima.p_slower, b.minima.p_faster))}};
  if (!exact) {
    effects.push_back({"runs with a hitch", std::to_string(b.hitchy.a), std::to_string(b.hitchy.b),
                       change(static_cast<double>(b.hitchy.a), static_cast<double>(b.hitchy.b)),
                       p(b.hitchy.p)});
  }
  effects.push_back({"missing or too coarse, % of the image", three_digits(b.missing.a),
                     three_digits(b.missing.b), change(b.missing.a, b.missing.b), p(b.missing.p)});
  effects.push_back({"error of LODs, pixels", three_digits(b.error.a), three_digits(b.error.b),
                     change(b.error.a, b.error.b), p(b.error.p)});
  return effects;
}

// Draws the ratio of frame times with its interval, over the range that counts as the same.
std::string interval_drawing(const Batch& batch) {
  static constexpr double kLow = 0.8, kHigh = 1.25, kWidth = 320;
  const auto x = [](double ratio) {
    return (std::clamp(ratio, kLow, kHigh) - kLow) / (kHigh - kLow) * kWidth;
  };
  return fmt::format(
      "<svg class=\"interval\" viewBox=\"-4 0 328 34\" role=\"img\" aria-label=\"interval\">"
      "<rect class=\"fill9\" x=\"{:.1f}\" width=\"{:.1f}\" y=\"0\" height=\"18\"/>"
      "<line class=\"grid\" x1=\"0\" x2=\"320\" y1=\"9\" y2=\"9\"/>"
      "<line class=\"stroke2 thick\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"9\" y2=\"9\"/>"
      "<circle class=\"fill2\" cx=\"{:.1f}\" cy=\"9\" r=\"4.5\"/>"
      "<text x=\"0\" y=\"32\">B is 20 % faster</text><text x=\"{:.1f}\" y=\"32\" "
      "text-anchor=\"middle\">same</text><text x=\"320\" y=\"32\" text-anchor=\"end\">25 % "
      "slower</text></svg>",
      x(1 / kSlowerRatio), x(kSlowerRatio) - x(1 / kSlowerRatio), x(batch.minima.low),
      x(batch.minima.high), x(batch.minima.ratio), x(1.0));
}

std::string batch_section(const Comparison& comparison, std::size_t index) {
  const Batch& batch = comparison.batches[index];
  const std::string name = comparison.exact ? "Effects, on the virtual clock"
                           : index == 0     ? "Effects, first batch"
                                            : "Effects, second batch (confirms the first)";
  std::string html = fmt::format(
      "<section><h2>{}: {} pair{}, {} frames each</h2>{}<table><tr><th></th><td>A</td><td>B</td>"
      "<td>effect</td><td>by chance</td></tr>",
      name, batch.pairs, batch.pairs == 1 ? "" : "s", batch.frames, interval_drawing(batch));
  for (const Effect& e : effects_of(batch, comparison.exact))
    html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>", e.name,
                        e.a, e.b, e.effect, e.chance);
  if (index == 1)
    html += fmt::format(
        "<tr><th>1 % of frames that slowed most, both batches</th><td></td><td></td><td>× "
        "{:.3f}</td>"
        "<td>p {:.4f}</td></tr><tr><th>slowest frames, relative to their typical time, both "
        "batches</th>"
        "<td>{:.2f}</td><td>{:.2f}</td><td>× {:.3f}</td><td>p {:.4f}</td></tr>",
        comparison.tail.ratio, comparison.tail.p, comparison.rare.a, comparison.rare.b,
        comparison.rare.b / comparison.rare.a, comparison.rare.p);
  return html + "</table></section>\n";
}

std::string_view class_of(Verdict verdict) {
  return verdict == Verdict::kWorse ? "bad" : verdict == Verdict::kInconclusive ? "fair" : "good";
}

std::string verdict_section(const Comparison& comparison, const FalseAlarms* alarms) {
  std::string html = fmt::format("<section class=\"verdict {}\"><b>{}</b>\n",
                                 class_of(comparison.verdict), headline(comparison));
  for (const auto& sentences : {comparison.differences, comparison.reasons})
    for (const std::string& sentence : sentences)
      html += fmt::format("<p>{}</p>\n", escaped(sentence));
  if (alarms != nullptr)
    html += fmt::format(
        "<p class=\"advice\">A compared with itself {} times: {} worse, {} better, {} "
        "inconclusive. This is the false alarm rate on this machine.</p>\n",
        alarms->comparisons, alarms->worse, alarms->better, alarms->inconclusive);
  return html + "</section>\n";
}

// The conditions that are only shown, of both sides.
std::string conditions_section(const Comparison& comparison) {
  const auto& [a, b] = comparison.shown;
  std::string html;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n", escaped(a[i].name),
                        escaped(a[i].text), escaped(b[i].text));
  if (html.empty()) return {};
  return "<section><table><tr><th></th><th>A</th><th>B</th></tr>\n" + html + "</table></section>\n";
}

// The game's figures.
std::string figures_section(const Comparison& comparison) {
  std::string html;
  for (const ComparedFigure& each : comparison.figures)
    html += fmt::format("<li>{}</li>\n", escaped(to_text(each)));
  if (html.empty()) return {};
  return "<section><b>Figures of the game, which decide nothing: A and B</b><ul>\n" + html +
         "</ul></section>\n";
}

constexpr std::string_view kStyle =
    ".effects section { background:var(--card); border:1px solid var(--edge); border-radius:10px;"
    " margin-top:14px; padding:14px 16px; overflow-x:auto }\n"
    ".effects td { padding-left:12px; white-space:nowrap } .effects th { white-space:normal }\n"
    ".interval { max-width:420px; margin:4px 0 8px } .thick { stroke-width:3 }\n";

}  // namespace

std::string headline(const Comparison& comparison) {
  const Batch& last = comparison.batches.back();
  const bool missing = last.missing.b > last.missing.a && last.missing.p <= kSignificant;
  const bool coarser = last.error.b > last.error.a && last.error.p <= kSignificant;
  const bool less = missing || coarser;
  const bool slower = last.minima.ratio > (comparison.exact ? 1 : kSlowerRatio);
  switch (comparison.verdict) {
    case Verdict::kSame:
      return "B is the same as A";
    case Verdict::kBetter:
      return "B is better: faster, and it shows as much";
    case Verdict::kWorse:
      if (less && last.minima.ratio < 1)
        return "B is worse: its frames are faster only because it draws "
               "less";
      return less     ? "B is worse: it shows less"
             : slower ? "B is worse: it is slower"
                      : "B is worse: some of its frames are slower";
    case Verdict::kInconclusive:
      break;
  }
  return comparison.noise_percent > 0
             ? fmt::format("Inconclusive: the noise is ±{:.1f} %", comparison.noise_percent)
             : "Inconclusive";
}

std::string to_html(const Comparison& comparison, Runs a, Runs b, const Sides& sides,
                    const FalseAlarms* alarms) {
  std::string body = fmt::format(
      "<h1>Comparison of two builds</h1>\n<p class=\"lead\">{} of each, at {} × {}{}</p>\n"
      "<p class=\"command\"><span class=\"swatch{} key\">A</span> <code>{}</code><br>"
      "<span class=\"swatch{} key\">B</span> <code>{}</code></p>\n",
      a.size() == 1 ? std::string("One run") : fmt::format("{} runs", a.size()), a.front().width,
      a.front().height, sides.test.empty() ? "" : ", test " + escaped(sides.test), kColourA,
      escaped(sides.a), kColourB, escaped(sides.b));
  body += verdict_section(comparison, alarms) + "<div class=\"effects\">\n";
  for (std::size_t i = comparison.batches.size(); i-- > 0;)
    body += batch_section(comparison, i);
  body += conditions_section(comparison) + figures_section(comparison) + "</div>\n" + plots(a, b);
  const bool same = comparison.verdict == Verdict::kSame;
  return telemetry::page_html(
      fmt::format("psygen: B is {} A", same ? "the same as" : "compared with"), kStyle, body,
      telemetry::page_script());
}

}  // namespace psygen::compare
