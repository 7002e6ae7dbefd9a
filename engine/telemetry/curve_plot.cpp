#include "engine/telemetry/curve_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/telemetry/page.hpp"

namespace psygen::telemetry {
namespace {

// Size of the drawing, in units of its view box.
constexpr double kWidth = 500, kHeight = 300;
constexpr double kLeft = 62, kRight = 488, kTop = 14, kBottom = 252;

class Drawing {
 public:
  explicit Drawing(const CurvePlot& plot) : plot_(plot) {
    if (!plot.x.empty()) {
      low_x_ = plot.x.front();
      high_x_ = std::max(plot.x.back(), low_x_ + 1e-9);
    }
    for (const Curve& curve : plot.curves) {
      for (const double value : curve.values)
        if (std::isfinite(value)) top_ = std::max(top_, value * 1.06);
    }
    if (top_ <= 0) top_ = 1;
  }

  std::string svg() {
    fmt::format_to(out(), "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", kWidth,
                   kHeight, escaped(plot_.title));
    draw_axes();
    for (const Curve& curve : plot_.curves)
      curve.kind == CurveKind::kPoints ? draw_points(curve) : draw_line(curve);
    return std::move(text_) + "</svg>";
  }

 private:
  std::back_insert_iterator<std::string> out() { return std::back_inserter(text_); }
  double x_of(double x) const {
    return kLeft + (x - low_x_) / (high_x_ - low_x_) * (kRight - kLeft);
  }
  double y_of(double value) const { return kBottom - value / top_ * (kBottom - kTop); }

  void draw_axes() {
    const double y_step = nice_step(top_, 6);
    for (double value = 0; value <= top_; value += y_step) {
      fmt::format_to(out(),
                     "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
                     "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:.6g}</text>",
                     kLeft, kRight, y_of(value), kLeft - 6, y_of(value) + 4, value);
    }
    const bool integers =
        std::all_of(plot_.x.begin(), plot_.x.end(), [](double x) { return x == std::floor(x); });
    const double x_step = std::max(nice_step(high_x_ - low_x_, 6), integers ? 1.0 : 1e-9);
    for (double x = std::ceil(low_x_ / x_step) * x_step; x <= high_x_ + 1e-9; x += x_step) {
      fmt::format_to(out(), "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:.6g}</text>",
                     x_of(x), kBottom + 18, x);
    }
    fmt::format_to(out(),
                   "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>"
                   "<text x=\"{}\" y=\"{}\">{}</text>",
                   (kLeft + kRight) / 2, kBottom + 38, escaped(plot_.x_name), kLeft + 6, kTop + 10,
                   escaped(plot_.unit));
  }

  std::size_t value_count(const Curve& curve) const {
    return std::min(curve.values.size(), plot_.x.size());
  }

  // Draws each run of values without gaps.
  void draw_line(const Curve& curve) {
    std::vector<std::pair<double, double>> stretch;
    const auto end_stretch = [&] {
      if (stretch.size() == 1) {
        fmt::format_to(out(),
                       "<circle class=\"ring stroke{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\"/>",
                       curve.colour, stretch[0].first, stretch[0].second);
      } else if (stretch.size() > 1) {
        const char* dashed = curve.kind == CurveKind::kDashed ? " dashed" : "";
        fmt::format_to(out(), "<polyline class=\"line{} stroke{}\" points=\"", dashed,
                       curve.colour);
        for (const auto& [x, y] : stretch)
          fmt::format_to(out(), "{:.1f},{:.1f} ", x, y);
        text_ += "\"/>";
      }
      stretch.clear();
    };
    for (std::size_t i = 0; i < value_count(curve); ++i) {
      if (std::isfinite(curve.values[i])) {
        stretch.emplace_back(x_of(plot_.x[i]), y_of(curve.values[i]));
      } else {
        end_stretch();
      }
    }
    end_stretch();
  }

  void draw_points(const Curve& curve) {
    for (std::size_t i = 0; i < value_count(curve); ++i) {
      if (!std::isfinite(curve.values[i])) continue;
      fmt::format_to(out(), "<circle class=\"fill{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>",
                     curve.colour, x_of(plot_.x[i]), y_of(curve.values[i]));
    }
  }

  const CurvePlot& plot_;
  double low_x_ = 0, high_x_ = 1, top_ = 0;
  std::string text_;
};

}  // namespace

double nice_step(double range, double steps) {
  const double raw = std::max(range, 1e-12) / steps;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  return power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
}

std::string curve_plot_html(const CurvePlot& plot) {
  std::string legend;
  for (const Curve& curve : plot.curves) {
    if (std::none_of(curve.values.begin(), curve.values.end(),
                     [](double value) { return std::isfinite(value); })) {
      continue;
    }
    legend +=
        fmt::format("<span><i class=\"swatch{}\"></i>{}</span>", curve.colour, escaped(curve.name));
  }
  const std::string note =
      plot.note.empty() ? "" : fmt::format("<p class=\"note\">{}</p>", escaped(plot.note));
  return fmt::format(
      "<figure><figcaption>{}</figcaption><div class=\"legend\">{}</div>{}{}</figure>\n",
      escaped(plot.title), legend, Drawing(plot).svg(), note);
}

}  // namespace psygen::telemetry
