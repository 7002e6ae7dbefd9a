// The page of a history.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/history/show.hpp"
#include "engine/telemetry/curve_plot.hpp"
#include "engine/telemetry/page.hpp"

namespace psygen::history {
namespace {

using telemetry::escaped;

// Size of a plot, in units of its view box.
constexpr double kWidth = 1060, kHeight = 170;
constexpr double kLeft = 70, kRight = 1048, kTop = 12, kBottom = 142;
constexpr std::size_t kMaxDots = 400;   // more entries are condensed to columns
constexpr std::size_t kMaxPlots = 100;  // further series have tables only
constexpr std::size_t kMaxLinks = 60;   // of a condensed plot, at its last changes

constexpr std::string_view kStyle = R"(
.dot{fill:var(--c1)} a .dot{cursor:pointer} a:hover .dot{stroke:var(--text);stroke-width:2}
.typical{fill:none;stroke:var(--text);stroke-width:1.6;opacity:.75}
.range{fill:none;stroke:var(--c1);stroke-width:2;opacity:.3}
.middle{fill:none;stroke:var(--c1);stroke-width:1.4}
.change{stroke-width:1.6;stroke-dasharray:4 3} .worse{stroke:var(--bad)} .better{stroke:var(--good)}
text.worse{fill:var(--bad);stroke:none;font-weight:600} text.better{fill:var(--good);stroke:none;font-weight:600}
b.worse{color:var(--bad)} b.better{color:var(--good)}
h2{font-size:18px;color:var(--text);margin:26px 0 2px} figure{padding:10px 14px 6px}
figcaption small{font-weight:400;color:var(--soft)} .list td{text-align:left;padding-right:14px} .list b{font-size:inherit}
nav a{margin-right:12px} section.notes{margin:12px 0} section.notes p{margin:2px 0}
)";

std::string date_text(std::int64_t seconds) {
  // gmtime() covers the years 1 to 9999.
  constexpr std::int64_t kMost = 253'402'300'799;
  if (seconds <= 0 || seconds > kMost) return "";
  return fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

std::string number_text(double value) {
  return std::abs(value) >= 1e6 ? fmt::format("{:.4g}", value) : fmt::format("{:.5g}", value);
}

bool is_web(std::string_view report) {
  return report.starts_with("https://") || report.starts_with("http://");
}

// A page, a capture, a summary or a count; else it is the folder of a run.
bool is_file(std::string_view name) {
  return name.ends_with(".html") || name.ends_with(".csv") || name.ends_with(".json") ||
         name.ends_with(".callgrind") || name.starts_with("callgrind.out");
}

// Only relative and absolute paths become links, and pages of the web; a scheme such as
// "javascript:" does not.
bool may_link(const std::string& report) {
  if (report.empty()) return false;
  if (is_web(report)) return true;
  const std::size_t colon = report.find(':');
  return colon == std::string::npos || report.find('/') < colon;
}

// The address of a report: of a folder, that of the page in it.
std::string link_of(const std::string& report, const std::string& base) {
  const bool web = is_web(report);
  const std::size_t slash = report.find_last_of('/') + 1;
  const bool is_page = web || is_file(std::string_view(report).substr(slash));
  std::string path = report.starts_with('/') || web || base.empty() ? "" : base + "/";
  path += is_page ? report : report + "/report.html";
  std::string address;
  for (const char c : path) {
    const bool special = !web && (c == '%' || c == '?' || c == '#');
    address += special ? fmt::format("%{:02X}", static_cast<unsigned>(c)) : std::string(1, c);
  }
  return escaped(address);
}

bool is_worse(const FigureRule& rule, double effect) {
  return (effect > 0) == rule.more_is_worse;
}

const char* class_of(const FigureRule& rule, double effect) {
  return is_worse(rule, effect) ? "worse" : "better";
}

// The drawing of one series.
class Drawing {
 public:
  Drawing(const ShownSeries& shown, const std::string& base)
      : shown_(shown), entries_(shown.series.entries), base_(base) {
    low_ = std::numeric_limits<double>::max();
    high_ = -low_;
    for (const Entry* entry : entries_) {
      low_ = std::min(low_, *entry->value);
      high_ = std::max(high_, *entry->value);
    }
    // A constant series, and noise of less than 2 %, must not fill the plot.
    const double margin = std::max((high_ - low_) * 0.12, std::abs(high_) * 0.02);
    low_ -= margin > 0 ? margin : 1;
    high_ += margin > 0 ? margin : 1;
    if (low_ < 0 && *entries_.front()->value >= 0) low_ = 0;
  }

  std::string svg() {
    fmt::format_to(out(), "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                   kHeight, escaped(entries_.front()->figure));
    draw_axes();
    if (entries_.size() <= kMaxDots) {
      draw_segments();
      draw_dots();
    } else {
      draw_columns();
      draw_segments();
      draw_links();
    }
    draw_changes();
    return std::move(text_) + "</svg>";
  }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(text_); }
  double x_of(double i) const {
    const double last = std::max(1.0, static_cast<double>(entries_.size()) - 1);
    return kLeft + i / last * (kRight - kLeft);
  }
  double x_of(std::size_t i) const { return x_of(static_cast<double>(i)); }
  double y_of(double value) const {
    return kBottom - (value - low_) / (high_ - low_) * (kBottom - kTop);
  }

  void draw_axes() {
    const double step = telemetry::nice_step(high_ - low_, 4);
    for (double value = std::ceil(low_ / step) * step; value <= high_; value += step)
      fmt::format_to(out(),
                     "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
                     "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>",
                     kLeft, kRight, y_of(value), kLeft - 6, y_of(value) + 4,
                     number_text(std::abs(value) < step * 1e-6 ? 0 : value));
    const std::size_t count = std::min<std::size_t>(entries_.size(), 6);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = count == 1 ? 0 : k * (entries_.size() - 1) / (count - 1);
      fmt::format_to(out(), "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\">{}</text>", x_of(i),
                     kBottom + 18,
                     k == 0           ? "start"
                     : k + 1 == count ? "end"
                                      : "middle",
                     escaped(entries_[i]->revision.substr(0, 14)));
    }
  }

  std::string tip(const Entry& entry) const {
    std::string text =
        fmt::format("{} {}, {}", number_text(*entry.value), entry.unit, entry.revision);
    if (const std::string date = date_text(entry.time); !date.empty()) text += ", " + date;
    return escaped(text);
  }

  void draw_dot(std::size_t i) {
    const Entry& entry = *entries_[i];
    const bool link = may_link(entry.report);
    if (link) fmt::format_to(out(), "<a href=\"{}\">", link_of(entry.report, base_));
    fmt::format_to(out(),
                   "<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"><title>{}</title>"
                   "</circle>{}",
                   x_of(i), y_of(*entry.value), tip(entry), link ? "</a>" : "");
  }

  void draw_dots() {
    for (std::size_t i = 0; i < entries_.size(); ++i)
      draw_dot(i);
  }

  // The last entry and those at changes of a condensed series.
  void draw_links() {
    const std::size_t count = std::min(shown_.changes.size(), kMaxLinks);
    for (const ChangePoint& change : std::span(shown_.changes).last(count))
      draw_dot(change.at);
    draw_dot(entries_.size() - 1);
  }

  // Medians of neighbouring entries, and the range of their values.
  void draw_columns() {
    std::string range, middle;
    for (std::size_t c = 0; c < kMaxDots; ++c) {
      const std::size_t begin = c * entries_.size() / kMaxDots;
      const std::size_t end = (c + 1) * entries_.size() / kMaxDots;
      std::vector<double> values;
      for (std::size_t i = begin; i < end; ++i)
        values.push_back(*entries_[i]->value);
      const auto [low, high] = std::ranges::minmax(values);
      const double x = x_of(static_cast<double>(begin + end - 1) / 2);
      fmt::format_to(std::back_inserter(range), "M{:.0f} {:.0f}V{:.0f}", x, y_of(low), y_of(high));
      fmt::format_to(std::back_inserter(middle), "{}{:.0f} {:.1f}", c == 0 ? "M" : "L", x,
                     y_of(median(values)));
    }
    fmt::format_to(out(), "<path class=\"range\" d=\"{}\"/><path class=\"middle\" d=\"{}\"/>",
                   range, middle);
  }

  // Medians between the changes.
  void draw_segments() {
    std::size_t begin = 0;
    for (std::size_t k = 0; k <= shown_.changes.size(); ++k) {
      const std::size_t end = k < shown_.changes.size() ? shown_.changes[k].at : entries_.size();
      std::vector<double> values;
      for (std::size_t i = begin; i < end; ++i)
        values.push_back(*entries_[i]->value);
      fmt::format_to(out(), "<path class=\"typical\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", x_of(begin),
                     y_of(median(values)), x_of(end - 1));
      begin = end;
    }
  }

  void draw_changes() {
    for (const ChangePoint& change : shown_.changes) {
      const double x = x_of(static_cast<double>(change.at) - 0.5);
      const char* const name = class_of(shown_.series.rule, change.effect);
      const bool left = x > kRight - 90;
      fmt::format_to(out(),
                     "<path class=\"change {0}\" d=\"M{1:.1f} {2}V{3}\"/><text class=\"{0}\" "
                     "x=\"{4:.1f}\" y=\"{5}\" text-anchor=\"{6}\">{7}</text>",
                     name, x, kTop, kBottom, left ? x - 5 : x + 5, kTop + 9, left ? "end" : "start",
                     change_text(shown_.series.rule, change.effect));
    }
  }

  const ShownSeries& shown_;
  const std::vector<const Entry*>& entries_;
  const std::string& base_;
  double low_ = 0, high_ = 1;
  std::string text_;
};

std::string change_sentence(const ShownSeries& shown, const ChangePoint& change,
                            const std::string& base) {
  const Entry& at = *shown.series.entries[change.at];
  const std::string date = date_text(at.time);
  std::string sentence =
      fmt::format("<b class=\"{}\">{}</b> at {}{}", class_of(shown.series.rule, change.effect),
                  change_text(shown.series.rule, change.effect), escaped(at.revision),
                  date.empty() ? "" : ", " + date);
  if (may_link(at.report))
    sentence += fmt::format(" (<a href=\"{}\">report</a>)", link_of(at.report, base));
  return sentence;
}

std::string caption(const ShownSeries& shown) {
  const Series& series = shown.series;
  const Entry& last = *series.entries.back();
  return fmt::format("{} <small>{} {} last, {} entr{}{}</small>", escaped(series.first->figure),
                     number_text(*last.value), escaped(series.first->unit), series.entries.size(),
                     series.entries.size() == 1 ? "y" : "ies",
                     series.left_out > 0 ? fmt::format(", {} left out", series.left_out) : "");
}

std::string changes_html(const ShownSeries& shown, const std::string& base) {
  constexpr std::size_t kMaxShown = 8;
  const std::size_t count = shown.changes.size();
  std::string html;
  for (std::size_t i = count - std::min(count, kMaxShown); i < count; ++i)
    html += (html.empty() ? "" : "; ") + change_sentence(shown, shown.changes[i], base);
  if (count > kMaxShown) html = fmt::format("{} earlier changes; {}", count - kMaxShown, html);
  return html.empty() ? "" : fmt::format("<p class=\"note\">{}</p>", html);
}

// All changes of the history, the last ones first.
std::string overview(const Shown& shown, const std::string& base) {
  struct Found {
    const ShownSeries* series;
    const ChangePoint* change;
    std::int64_t order;
  };
  constexpr std::size_t kMaxShown = 20;
  std::vector<Found> found;
  for (const ShownSeries& series : shown.series)
    for (const ChangePoint& change : series.changes)
      found.push_back({&series, &change, series.series.entries[change.at]->order});
  std::ranges::stable_sort(found, std::greater<>(), &Found::order);
  if (found.empty()) return "<section class=\"verdict\"><b>No figure changes</b></section>\n";
  std::string html =
      fmt::format("<section class=\"verdict\"><b>{} change{}</b><table class=\"list\">",
                  found.size(), found.size() == 1 ? "" : "s");
  for (const Found& each : std::span(found).first(std::min(found.size(), kMaxShown)))
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>",
                        escaped(each.series->series.first->test),
                        escaped(each.series->series.first->figure),
                        change_sentence(*each.series, *each.change, base));
  html += "</table>";
  if (found.size() > kMaxShown)
    html +=
        fmt::format("<p>{} earlier ones are marked in the plots.</p>", found.size() - kMaxShown);
  return html + "</section>\n";
}

// Figures that gate come first, then those that change.
std::vector<const ShownSeries*> in_order(const Shown& shown) {
  std::vector<const ShownSeries*> order;
  for (const ShownSeries& series : shown.series)
    if (!series.series.entries.empty()) order.push_back(&series);
  std::ranges::stable_sort(order, [](const ShownSeries* a, const ShownSeries* b) {
    const auto key = [](const ShownSeries* s) {
      return std::tuple(s->series.first->test, !s->series.rule.gates, s->changes.empty());
    };
    return key(a) < key(b);
  });
  return order;
}

}  // namespace

std::string to_html(const Shown& shown, const std::string& name, const std::string& base) {
  const auto order = in_order(shown);
  std::string html = fmt::format("<h1>History</h1>\n<p class=\"lead\">{}: {} series</p>\n",
                                 escaped(name), order.size());
  html += overview(shown, base);
  if (!shown.notes.empty()) {
    html += "<section class=\"notes\">";
    for (const std::string& note : shown.notes)
      html += fmt::format("<p class=\"note\">{}</p>", escaped(note));
    html += "</section>\n";
  }
  std::string test, fingerprint;
  std::size_t plots = 0;
  for (const ShownSeries* each : order) {
    const Entry& first = *each->series.first;
    if (first.test != test || plots == 0) {
      html += fmt::format("<h2>{}</h2>\n", escaped(test = first.test));
      fingerprint.clear();
    }
    const bool same = first.fingerprint == fingerprint;
    fingerprint = first.fingerprint;
    html += fmt::format("<figure><figcaption>{}</figcaption>{}", caption(*each),
                        same || fingerprint.empty()
                            ? ""
                            : fmt::format("<p class=\"note\">{}</p>", escaped(fingerprint)));
    if (plots++ < kMaxPlots)
      html += Drawing(*each, base).svg();
    else
      html += "<p class=\"note\">not plotted: choose it with --test or --figure</p>";
    html += changes_html(*each, base) + "</figure>\n";
  }
  return telemetry::page_html("psygen: history", kStyle, html);
}

}  // namespace psygen::history
