#include "engine/telemetry/report_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/telemetry/units.hpp"

namespace psygen::telemetry {
namespace {

// The drawing, in units of its view box.
constexpr double kWidth = 1000, kHeight = 250;
constexpr double kLeft = 60, kRight = 888, kTop = 14, kBottom = 206;
constexpr std::size_t kMaxColumns = 900;

// Neighbouring frames that are drawn as one.
struct Column {
  double time_s = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double sum = 0;
  double count = 0;
  double mean() const { return count > 0 ? sum / count : 0; }
};

// A column without finite values is empty.
std::vector<Column> columns_of(std::span<const double> times, std::span<const double> values) {
  const std::size_t count = std::min(times.size(), kMaxColumns);
  std::vector<Column> columns(count);
  for (std::size_t i = times.size(); i-- > 0;)
    columns[i * count / times.size()].time_s = times[i];
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    Column& column = columns[i * count / times.size()];
    column.low = std::min(column.low, values[i]);
    column.high = std::max(column.high, values[i]);
    column.sum += values[i];
    ++column.count;
  }
  return columns;
}

// Calls visit(first, end) for each stretch of columns that have values.
template <class Visit>
void for_each_stretch(std::span<const Column> columns, const Visit& visit) {
  for (std::size_t first = 0; first < columns.size();) {
    std::size_t end = first;
    while (end < columns.size() && columns[end].count > 0)
      ++end;
    if (end > first) visit(first, end);
    first = end + 1;
  }
}

std::string tick_text(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, decimals);
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    for (const PlotSeries& series : plot.series)
      columns_.push_back(columns_of(plot.times_s, series.values));
    if (!plot.times_s.empty()) {
      start_s_ = plot.times_s.front();
      end_s_ = std::max(plot.times_s.back(), start_s_ + 1e-3);
    }
    top_ = plot.top > 0 ? plot.top : top_of_data();
  }

  std::string svg() {
    fmt::format_to(out(), "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                   kHeight, escaped(plot_.title));
    draw_warmup();
    draw_axes();
    draw_series();
    draw_marks();
    for (const PlotLevel& level : plot_.levels)
      draw_level(level);
    text_ += "<line class=\"cursor\" visibility=\"hidden\" y1=\"14\" y2=\"206\"/></svg>";
    return std::move(text_);
  }

  // What the script shows under the pointer: x positions, times, and values as drawn.
  nlohmann::json data() const {
    nlohmann::json json;
    json["unit"] = plot_.unit;
    json["x"] = nlohmann::json::array();
    json["t"] = nlohmann::json::array();
    if (!columns_.empty()) {
      for (const Column& column : columns_.front()) {
        json["x"].push_back(std::round(x_of(column.time_s) * 10) / 10);
        json["t"].push_back(std::round(column.time_s * 1000) / 1000);
      }
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      nlohmann::json values = nlohmann::json::array();
      for (const Column& column : columns_[i]) {
        const double value = std::round(shown(column) * 1000) / 1000;
        values.push_back(column.count > 0 ? nlohmann::json(value) : nlohmann::json(nullptr));
      }
      json["series"].push_back({{"name", plot_.series[i].name}, {"v", values}});
    }
    return json;
  }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(text_); }
  double x_of(double time_s) const {
    return kLeft + (time_s - start_s_) / (end_s_ - start_s_) * (kRight - kLeft);
  }
  double y_of(double value) const {
    return kBottom - std::clamp(value / top_, 0.0, 1.0) * (kBottom - kTop);
  }
  double shown(const Column& column) const {
    return plot_.kind == PlotKind::kPeaks ? column.high : column.mean();
  }

  double top_of_data() const {
    double top = 0;
    for (const PlotLevel& level : plot_.levels)
      top = std::max(top, level.value);
    for (const std::vector<Column>& columns : columns_) {
      for (const Column& column : columns)
        top = std::max(top, column.high);
    }
    if (plot_.kind == PlotKind::kStacked) {
      for (std::size_t k = 0; k < columns_.front().size(); ++k) {
        double sum = 0;
        for (const std::vector<Column>& columns : columns_)
          sum += k < columns.size() ? columns[k].mean() : 0;
        top = std::max(top, sum);
      }
    }
    return top > 0 ? top * 1.08 : 1.0;
  }

  void draw_warmup() {
    if (plot_.warmup_s <= start_s_) return;
    const double right = x_of(std::min(plot_.warmup_s, end_s_));
    fmt::format_to(out(),
                   "<rect class=\"warmup\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\">"
                   "<title>warm-up, left out of the figures</title></rect>",
                   kLeft, kTop, right - kLeft, kBottom - kTop);
  }

  void draw_axes() {
    const double y_step = nice_step(top_, 5);
    for (double y = 0; y <= top_ * 1.0001; y += y_step) {
      fmt::format_to(out(),
                     "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
                     "<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
                     kLeft, kRight, y_of(y), y_of(y), kLeft - 8, y_of(y) + 4, tick_text(y, y_step));
    }
    const double x_step = nice_step(end_s_ - start_s_, 12);
    for (double t = std::ceil(start_s_ / x_step) * x_step; t <= end_s_ + 1e-9; t += x_step) {
      fmt::format_to(out(),
                     "<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                     x_of(t), kBottom + 18, tick_text(t, x_step));
    }
    fmt::format_to(out(),
                   "<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">flight time (s)"
                   "</text><text class=\"axis\" transform=\"translate(14 {}) rotate(-90)\" "
                   "text-anchor=\"middle\">{}</text>",
                   (kLeft + kRight) / 2, kBottom + 38, (kTop + kBottom) / 2, escaped(plot_.unit));
  }

  // Closed paths between two curves over the same columns.
  template <class Low, class High>
  void draw_area(std::size_t series, const char* style, const Low& low, const High& high) {
    const std::vector<Column>& columns = columns_[series];
    std::string path;
    const auto add = [&](double value, std::size_t k) {
      fmt::format_to(std::back_inserter(path), " {:.1f},{:.1f}", x_of(columns[k].time_s),
                     y_of(value));
    };
    for_each_stretch(columns, [&](std::size_t first, std::size_t end) {
      path += "M";
      for (std::size_t k = first; k < end; ++k)
        add(high(k), k);
      for (std::size_t k = end; k-- > first;)
        add(low(k), k);
      path += "Z";
    });
    if (path.empty()) return;
    fmt::format_to(out(), "<path class=\"{} fill{}\" d=\"{}\"/>", style,
                   plot_.series[series].colour, path);
  }

  // A value without neighbours is a dot.
  void draw_line(std::size_t series) {
    const std::vector<Column>& columns = columns_[series];
    const int colour = plot_.series[series].colour;
    std::string path;
    for_each_stretch(columns, [&](std::size_t first, std::size_t end) {
      if (end - first == 1) {
        fmt::format_to(out(), "<circle class=\"fill{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>",
                       colour, x_of(columns[first].time_s), y_of(shown(columns[first])));
        return;
      }
      path += "M";
      for (std::size_t k = first; k < end; ++k)
        fmt::format_to(std::back_inserter(path), " {:.1f},{:.1f}", x_of(columns[k].time_s),
                       y_of(shown(columns[k])));
    });
    if (!path.empty())
      fmt::format_to(out(), "<path class=\"line stroke{}\" d=\"{}\"/>", colour, path);
  }

  void draw_stack() {
    std::vector<double> below(columns_.empty() ? 0 : columns_.front().size(), 0.0);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      std::vector<double> above = below;
      for (std::size_t k = 0; k < above.size(); ++k)
        above[k] += columns_[i][k].mean();
      draw_area(
          i, "stack", [&](std::size_t k) { return below[k]; },
          [&](std::size_t k) { return above[k]; });
      below = std::move(above);
    }
  }

  void draw_series() {
    if (plot_.kind == PlotKind::kStacked) return draw_stack();
    const bool peaks = plot_.kind == PlotKind::kPeaks;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::vector<Column>& columns = columns_[i];
      draw_area(
          i, "band", [&](std::size_t k) { return peaks ? 0.0 : columns[k].low; },
          [&](std::size_t k) { return columns[k].high; });
      draw_line(i);
    }
  }

  // Marks at the same place are drawn once.
  void draw_marks() {
    if (plot_.marks_s.empty()) return;
    std::string path;
    double last = -1;
    for (const double time_s : plot_.marks_s) {
      const double x = std::round(x_of(time_s));
      if (x == last) continue;
      fmt::format_to(std::back_inserter(path), "M{} {}v-8", x, kBottom);
      last = x;
    }
    fmt::format_to(
        out(), "<path class=\"mark\" d=\"{}\"><title>not in the figures of times</title></path>",
        path);
  }

  // The label is to the right of the drawing, where no curve crosses it.
  void draw_level(const PlotLevel& level) {
    const double y = y_of(level.value);
    fmt::format_to(out(),
                   "<line class=\"level\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>"
                   "<text class=\"level\" x=\"{}\" y=\"{:.1f}\">{}</text>",
                   kLeft, kRight, y, y, kRight + 6, level.label_below ? y + 11 : y - 1,
                   escaped(level.label));
  }

  const Plot& plot_;
  std::vector<std::vector<Column>> columns_;
  double start_s_ = 0, end_s_ = 1, top_ = 1;
  std::string text_;
};

std::string legend(const Plot& plot) {
  if (plot.series.size() < 2) return "";
  std::string text = "<div class=\"legend\">";
  for (const PlotSeries& series : plot.series) {
    text += fmt::format("<span><i class=\"swatch{}\"></i>{}</span>", series.colour,
                        escaped(series.name));
  }
  return text + "</div>";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

double nice_step(double range, double steps) {
  const double raw = std::max(range, 1e-12) / steps;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  return power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
}

std::string plot_html(const Plot& plot) {
  Drawing drawing(plot);
  std::string data = drawing.data().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos;)
    data.replace(at, 1, "\\u003c");
  const std::string note =
      plot.note.empty() ? "" : fmt::format("<p class=\"note\">{}</p>", escaped(plot.note));
  return fmt::format(
      "<figure><figcaption>{}</figcaption>{}{}<div class=\"readout\" hidden></div>{}"
      "<script type=\"application/json\">{}</script></figure>\n",
      escaped(plot.title), legend(plot), drawing.svg(), note, data);
}

}  // namespace psygen::telemetry
