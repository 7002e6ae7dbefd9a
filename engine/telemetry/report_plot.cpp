#include "engine/telemetry/report_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace psygen::telemetry {
namespace {

std::string legend(const Plot& plot) {
  if (plot.series.size() < 2) return "";
  std::string text = "<div class=\"legend\">";
  for (const PlotSeries& series : plot.series) {
    text += fmt::format("<span><i class=\"swatch{}\"></i>{}</span>", series.colour,
                        escaped(series.name));
  }
  return text + "</div>";
}

// Data for the script.
std::string data(const Plot& plot) {
  constexpr std::array<std::string_view, 3> kKinds = {"line", "peaks", "stacked"};
  std::string text = fmt::format(
      R"({{"title":{},"unit":{},"kind":"{}","top":{:.6g},"zooms":{},"small":{},"levels":[)",
      json_text(plot.title), json_text(plot.unit), kKinds[static_cast<std::size_t>(plot.kind)],
      plot.top, plot.zooms, plot.small);
  for (const PlotLevel& level : plot.levels)
    text += fmt::format("{}{{\"label\":{},\"value\":{:.6g},\"below\":{}}}",
                        &level == plot.levels.data() ? "" : ",", json_text(level.label),
                        level.value, level.label_below);
  text += "],\"series\":[";
  for (const PlotSeries& series : plot.series)
    text += fmt::format("{}{{\"name\":{},\"colour\":{},\"v\":{}}}",
                        &series == plot.series.data() ? "" : ",", json_text(series.name),
                        series.colour, json_numbers(series.values));
  return text + "]}";
}

}  // namespace

std::string escaped(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr std::array<std::string_view, 5> kEntities = {"&amp;", "&lt;", "&gt;", "&quot;",
                                                         "&#39;"};
  std::string result;
  for (const char& c : text) {
    const std::size_t at = kSpecial.find(c);
    result += at == std::string_view::npos ? std::string_view(&c, 1) : kEntities[at];
  }
  return result;
}

std::string json_text(std::string_view text) {
  std::string result =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = result.find('<', at)) != std::string::npos;)
    result.replace(at, 1, "\\u003c");
  return result;
}

std::string json_numbers(std::span<const double> values) {
  std::string text = "[";
  for (const double value : values) {
    if (std::isfinite(value)) {
      fmt::format_to(std::back_inserter(text), "{:.6g},", value);
    } else {
      text += "null,";
    }
  }
  if (text.size() > 1) text.pop_back();
  return text + "]";
}

double nice_step(double range, double steps) {
  const double raw = std::max(range, 1e-12) / steps;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double ratio = raw / power;
  return power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
}

std::string plot_html(const Plot& plot) {
  const std::string note =
      plot.note.empty() ? "" : fmt::format("<p class=\"note\">{}</p>", escaped(plot.note));
  return fmt::format(
      "<figure class=\"plot\"><figcaption>{}</figcaption>{}<div class=\"drawing\"></div>{}"
      "<script type=\"application/json\">{}</script></figure>\n",
      escaped(plot.title), legend(plot), note, data(plot));
}

}  // namespace psygen::telemetry
