#include "engine/telemetry/page.hpp"

#include <fmt/format.h>

namespace psygen::telemetry {
namespace {

std::string texts(const std::map<std::size_t, std::string>& by_row) {
  std::string text = "{";
  for (const auto& [row, value] : by_row)
    text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", row, json_text(value));
  return text + "}";
}

std::string series(const std::vector<RowFigure>& all) {
  std::string text = "[";
  for (const RowFigure& each : all)
    text += fmt::format("{}{{\"name\":{},\"unit\":{},\"v\":{}}}", text.size() > 1 ? "," : "",
                        json_text(each.name), json_text(each.unit), json_numbers(each.values));
  return text + "]";
}

}  // namespace

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
      "\"warmup\":{:.6g},\"times\":{},\"apart\":{},\"pictures\":{},\"figures\":{},\"parts\":{}}}"
      "</script>\n",
      kTools, json_numbers(rows.times_s), json_numbers(rows.numbers), rows.every, rows.warmup_s,
      rows.timed_series, texts(rows.apart), texts(rows.pictures), series(rows.figures),
      series(rows.parts));
}

std::string distribution_html() {
  return "<figure id=\"distribution\"><figcaption>Distribution of frame times</figcaption>"
         "<div class=\"legend\"></div><div class=\"drawing\"></div>"
         "<div class=\"percentiles\"></div><p class=\"note\"></p></figure>\n";
}

}  // namespace psygen::telemetry
