#include "engine/telemetry/page.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace psygen::telemetry {
namespace {

// The texts of all elements, separated by commas.
template <class Range, class Text>
std::string listed(const Range& all, const Text& text) {
  std::string list;
  std::string_view separator;
  for (const auto& element : all) {
    fmt::format_to(std::back_inserter(list), "{}{}", separator, text(element));
    separator = ",";
  }
  return list;
}

// JSON for a <script> element: a quoted text that cannot start a tag.
std::string json_text(std::string_view text) {
  std::string result =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = result.find('<', at)) != std::string::npos;)
    result.replace(at, 1, "\\u003c");
  return result;
}

// A list of numbers with six digits. Numbers that are not finite are null.
std::string json_numbers(const std::vector<double>& values) {
  const auto text = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("null");
  };
  return fmt::format("[{}]", listed(values, text));
}

std::string swatches(const Plot& plot) {
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
  const std::string levels = listed(plot.levels, [](const PlotLevel& level) {
    return fmt::format(R"({{"label":{},"value":{:.6g},"below":{}}})", json_text(level.label),
                       level.value, level.label_below);
  });
  const std::string series = listed(plot.series, [](const PlotSeries& each) {
    return fmt::format(R"({{"name":{},"colour":{},"v":{}}})", json_text(each.name), each.colour,
                       json_numbers(each.values));
  });
  return fmt::format(R"({{"title":{},"unit":{},"kind":"{}","top":{:.6g},"zooms":{},"small":{},)"
                     R"("levels":[{}],"series":[{}]}})",
                     json_text(plot.title), json_text(plot.unit),
                     kKinds[static_cast<std::size_t>(plot.kind)], plot.top, plot.zooms, plot.small,
                     levels, series);
}

std::string texts(const std::map<std::size_t, std::string>& by_row) {
  return listed(by_row, [](const auto& row) {
    return fmt::format("\"{}\":{}", row.first, json_text(row.second));
  });
}

std::string figures(const std::vector<RowFigure>& all) {
  return listed(all, [](const RowFigure& each) {
    return fmt::format(R"({{"name":{},"unit":{},"v":{}}})", json_text(each.name),
                       json_text(each.unit), json_numbers(each.values));
  });
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

std::string page_html(std::string_view title, std::string_view style, std::string_view body,
                      std::string_view script) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<title>{}</title><style>\n{}{}</style></head><body><main>\n{}</main>{}</body></html>\n",
      escaped(title), page_style(), style, body,
      script.empty() ? "" : fmt::format("<script>{}</script>", script));
}

std::string plot_html(const Plot& plot) {
  const std::string note =
      plot.note.empty() ? "" : fmt::format("<p class=\"note\">{}</p>", escaped(plot.note));
  return fmt::format(
      "<figure class=\"plot\"><figcaption>{}</figcaption>{}<div class=\"drawing\"></div>{}"
      "<script type=\"application/json\">{}</script></figure>\n",
      escaped(plot.title), swatches(plot), note, data(plot));
}

std::string page_tools_html(const PageRows& rows) {
  constexpr std::string_view kTools = R"(<nav class="tools" hidden>
<span class="buttons"><button id="whole" disabled>Whole flight</button><button id="out" disabled>Zoom out</button></span>
<span id="range" role="status"></span>
<span class="hint">Drag across a plot to zoom, click to see a frame.</span></nav>
<noscript><p class="note">The plots need JavaScript. All figures are in the tables below.</p></noscript>
<aside id="row" hidden aria-label="one frame"></aside>
)";
  return fmt::format(
      "{}<script type=\"application/json\" id=\"rows\">{{\"t\":{},\"n\":{},\"every\":{},"
      "\"warmup\":{:.6g},\"times\":{},\"apart\":{{{}}},\"pictures\":{{{}}},\"marks\":{{{}}},"
      "\"figures\":[{}],"
      "\"parts\":[{}]}}</script>\n",
      kTools, json_numbers(rows.times_s), json_numbers(rows.numbers), rows.every, rows.warmup_s,
      rows.timed_series, texts(rows.apart), texts(rows.pictures), texts(rows.marks),
      figures(rows.figures), figures(rows.parts));
}

std::string distribution_html() {
  return "<figure id=\"distribution\"><figcaption>Distribution of frame times</figcaption>"
         "<div class=\"legend\"></div><div class=\"drawing\"></div>"
         "<div class=\"percentiles\"></div><p class=\"note\"></p></figure>\n";
}

}  // namespace psygen::telemetry
